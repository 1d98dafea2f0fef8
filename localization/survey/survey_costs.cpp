#include "localization/survey/survey_costs.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "localization/pose/map_estimate.hpp"
#include "maps/rotation_vector.hpp"

namespace lodestar {
namespace {

using Place = SurveyState::Place;
using Marker = SurveyState::Marker;

/// Writes rows of one block's derivative, row-major as in Ceres; null for a constant block.
template <typename Rows>
void write(const Rows& rows, Eigen::Index first_row, int columns, double* jacobian) {
  if (jacobian == nullptr) return;
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::Map<RowMajor>(jacobian + first_row * columns, rows.rows(), columns) = rows;
}

/// Derivatives by two places of the way between them, in the frame of the first and over a scale, and of the
/// turn.
struct ByPlaces {
  Eigen::Matrix<double, 3, 5> from = Eigen::Matrix<double, 3, 5>::Zero();
  Eigen::Matrix<double, 3, 5> to = Eigen::Matrix<double, 3, 5>::Zero();
};

ByPlaces by_places(const Eigen::Matrix2d& base_from_map, const Vec2& way_m, double scale) {
  ByPlaces by;
  by.to.topLeftCorner<2, 2>() = base_from_map / scale;
  by.to(2, 2) = 1.0;
  by.from = -by.to;
  by.from.block<2, 1>(0, 2) = Vec2(way_m.y(), -way_m.x()) / scale;
  return by;
}

/// The derivative is that of the translation and of the rotation about the map's axes, by place (5), mount
/// position (3) and mount turn (3).
struct CameraPose {
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
  Eigen::Matrix<double, 6, 11> by_unknowns = Eigen::Matrix<double, 6, 11>::Zero();
};

CameraPose camera_pose(const Place& place, const Vec3& mount_m, const Vec3& mount_turn_rad,
                       const Eigen::Matrix3d& believed) {
  const Eigen::Matrix3d turned = rotation_by({0.0, 0.0, place[2]});
  const Vec3 lean(place[3], place[4], 0.0);
  const Eigen::Matrix3d map_from_body = turned * rotation_by(lean);
  const Vec3 lever = map_from_body * mount_m;
  CameraPose pose;
  pose.map_from_camera.translation() = lever + Vec3(place.x(), place.y(), 0.0);
  pose.map_from_camera.linear() = map_from_body * rotation_by(mount_turn_rad) * believed;
  const auto turn_about = [&](int column, const Vec3& axis) {
    pose.by_unknowns.col(column) << axis.cross(lever), axis;
  };
  pose.by_unknowns.topLeftCorner<2, 2>().setIdentity();
  turn_about(2, Vec3::UnitZ());
  const Eigen::Matrix3d by_lean = turned * turn_by_vector(lean);
  turn_about(3, by_lean.col(0));
  turn_about(4, by_lean.col(1));
  pose.by_unknowns.block<3, 3>(0, 5) = map_from_body;
  pose.by_unknowns.block<3, 3>(3, 8) = map_from_body * turn_by_vector(mount_turn_rad);
  return pose;
}

/// Axes of a marker in the map: its plane's x and y, which printed face and map see mirrored.
struct MarkerAxes {
  Eigen::Matrix3d turned;   ///< Rz(yaw)
  Eigen::Matrix3d tilted;   ///< Exp(tilt)
  Eigen::Matrix3d by_tilt;  ///< left Jacobian of the tilt
  Eigen::Matrix<double, 3, 2> of_plane;

  explicit MarkerAxes(const Marker& marker)
      : turned(rotation_by({0.0, 0.0, marker[3]})),
        tilted(rotation_by({marker[4], marker[5], 0.0})),
        by_tilt(turn_by_vector({marker[4], marker[5], 0.0})) {
    of_plane.col(0) = turned * tilted.col(0);
    of_plane.col(1) = -turned * tilted.col(1);
  }
};

double wrapped(double angle_rad) {
  return wrap_angle(angle_rad);
}

}  // namespace

DotsOfSighting::DotsOfSighting(const KeyframeSighting& sighting, const SeenCells& cells,
                               const CameraModel& camera, const SurveyBelief& belief,
                               const SurveyOptions& options)
    : camera_(camera), belief_(belief) {
  for (const MarkerDot& dot : sighting.dots) {
    const double sigma = dot.sigma_px > 0.0 ? dot.sigma_px : options.dot_sigma_px;
    dots_.push_back({.cell_m = cell_in_marker(dot.cell),
                     .at = static_cast<int>(std::ranges::find(cells, dot.cell) - cells.begin()),
                     .pixel = dot.center_px,
                     .weight = 1.0 / std::max(sigma, options.least_dot_sigma_px)});
  }
  set_num_residuals(2 * static_cast<int>(dots_.size()));
  *mutable_parameter_block_sizes() = {5, 6, 3, 3, 2, 2 * static_cast<int>(cells.size())};
}

bool DotsOfSighting::Evaluate(const double* const* parameters, double* residuals, double** jacobians) const {
  const Marker marker = Eigen::Map<const Marker>(parameters[1]);
  const double scale = parameters[4][0];
  const double k1_off = parameters[4][1];
  const CameraPose camera =
      camera_pose(Eigen::Map<const Place>(parameters[0]), Eigen::Map<const Vec3>(parameters[2]),
                  Eigen::Map<const Vec3>(parameters[3]), belief_.base_from_camera.linear());
  const MarkerAxes axes(marker);
  const int offsets = parameter_block_sizes()[5];
  for (std::size_t i = 0; i < dots_.size(); ++i) {
    const Seen& dot = dots_[i];
    const Vec2 in_plane = dot.cell_m + Vec2(parameters[5][2 * dot.at], parameters[5][2 * dot.at + 1]);
    const Vec3 lever = scale * (axes.of_plane * in_plane);
    const Vec3 point = marker.head<3>() + lever;
    const auto seen = project_dot(camera.map_from_camera, point, camera_);
    if (!seen) return false;
    const Vec3 in_camera = camera.map_from_camera.inverse() * point;
    const Vec2 ray = in_camera.head<2>() / in_camera.z();
    const Vec2 by_k1 = ray.squaredNorm() * Vec2(camera_.fx_px * ray.x(), camera_.fy_px * ray.y());
    const auto row = static_cast<Eigen::Index>(2 * i);
    Eigen::Map<Vec2>(residuals + row) = dot.weight * (seen->pixel + k1_off * by_k1 - dot.pixel);
    if (jacobians == nullptr) continue;
    const Eigen::Matrix<double, 2, 11> by_pose = dot.weight * seen->jacobian * camera.by_unknowns;
    const Eigen::Matrix<double, 2, 3> by_point = -dot.weight * seen->jacobian.leftCols<3>();
    Eigen::Matrix<double, 3, 6> point_by;
    const Vec3 tilted_lever = axes.turned.transpose() * lever;
    point_by << Eigen::Matrix3d::Identity(), Vec3::UnitZ().cross(lever),
        axes.turned * Vec3(axes.by_tilt.col(0)).cross(tilted_lever),
        axes.turned * Vec3(axes.by_tilt.col(1)).cross(tilted_lever);
    write(by_pose.leftCols<5>(), row, 5, jacobians[0]);
    write(by_point * point_by, row, 6, jacobians[1]);
    write(by_pose.middleCols<3>(5), row, 3, jacobians[2]);
    write(by_pose.rightCols<3>(), row, 3, jacobians[3]);
    Eigen::Matrix2d by_common;
    by_common << by_point * (lever / scale), dot.weight * by_k1;
    write(by_common, row, 2, jacobians[4]);
    if (jacobians[5] != nullptr) {
      Eigen::Matrix<double, 2, Eigen::Dynamic> by_offsets =
          Eigen::Matrix<double, 2, Eigen::Dynamic>::Zero(2, offsets);
      by_offsets.middleCols<2>(2 * dot.at) = scale * by_point * axes.of_plane;
      write(by_offsets, row, offsets, jacobians[5]);
    }
  }
  return true;
}

WheelsBetween::WheelsBetween(const WheelSegment& segment, const WheelGauge& gauge, const WheelNoise& noise)
    : segment_(segment) {
  constexpr double least_m = 1e-4;  // no wheel is better
  Eigen::Matrix3d covariance = segment.covariance(gauge, noise);
  covariance.diagonal() += Vec3(square(least_m), square(least_m), square(least_m / gauge.track_m));
  root_information_ = covariance.inverse().llt().matrixU();
}

bool WheelsBetween::Evaluate(const double* const* parameters, double* residuals, double** jacobians) const {
  const Place from = Eigen::Map<const Place>(parameters[0]);
  const Place to = Eigen::Map<const Place>(parameters[1]);
  const double scale = parameters[2][0];
  const WheelMotion rolled = segment_.motion({.difference = parameters[2][1], .track_m = parameters[2][2]});
  const Eigen::Matrix2d base_from_map = Eigen::Rotation2Dd(-from[2]).toRotationMatrix();
  const Vec2 way_m = base_from_map * (to.head<2>() - from.head<2>());
  const Vec2 way = way_m / scale;
  Vec3 off;
  off << way - rolled.way_m, wrapped(to[2] - from[2] - rolled.turn_rad);
  Eigen::Map<Vec3> residual(residuals);
  residual = root_information_ * off;
  if (jacobians == nullptr) return true;
  const ByPlaces by = by_places(base_from_map, way_m, scale);
  Eigen::Matrix3d by_wheels;
  by_wheels << Vec3(-way.x() / scale, -way.y() / scale, 0.0), -rolled.by_gauge;
  write(root_information_ * by.from, 0, 5, jacobians[0]);
  write(root_information_ * by.to, 0, 5, jacobians[1]);
  write(root_information_ * by_wheels, 0, 3, jacobians[2]);
  return true;
}

/// The base's motion is that of the camera, less what the camera's arm t sweeps: way = c + t - R t.
CeilingBetween::CeilingBetween(const CeilingSegment& segment, const Vec3& believed_mount_m, double ceiling_m)
    : turn_rad_(segment.motion.yaw_rad),
      ceiling_m_(ceiling_m),
      above_camera_m_(ceiling_m - believed_mount_m.z()),
      root_information_(segment.covariance.inverse().llt().matrixU()) {
  const Vec2 arm_m = believed_mount_m.head<2>();
  const Vec2 swept_m = arm_m - Eigen::Rotation2Dd(turn_rad_) * arm_m;
  camera_way_m_ = segment.motion.position_m - swept_m;
}

bool CeilingBetween::Evaluate(const double* const* parameters, double* residuals, double** jacobians) const {
  const Place from = Eigen::Map<const Place>(parameters[0]);
  const Place to = Eigen::Map<const Place>(parameters[1]);
  const double scale = parameters[2][0];
  const double print = parameters[5][0];
  const Vec2 aside_by_print_m = above_camera_m_ * Vec2(parameters[4][1], -parameters[4][0]);
  const Vec2 aside_m = print * aside_by_print_m;
  const Vec2 arm_m = Vec2(parameters[3][0], parameters[3][1]) + aside_m;
  const double mount_yaw = parameters[4][2];
  const Eigen::Matrix2d base_from_map = Eigen::Rotation2Dd(-from[2]).toRotationMatrix();
  const Vec2 way = base_from_map * (to.head<2>() - from.head<2>());
  const Vec2 camera_way = Eigen::Rotation2Dd(mount_yaw) * camera_way_m_;
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(turn_rad_).toRotationMatrix();
  const Eigen::Matrix2d sweep = Eigen::Matrix2d::Identity() - turn;
  Eigen::Matrix2d aside_by_lean;
  aside_by_lean << 0.0, print * ceiling_m_, -print * ceiling_m_, 0.0;
  const Vec2 swayed = turn * aside_by_lean * to.tail<2>() - aside_by_lean * from.tail<2>();
  const Vec2 seen = (way + swayed - sweep * arm_m) / scale;
  Vec3 off;
  off << seen - camera_way, wrapped(to[2] - from[2] - turn_rad_);
  Eigen::Map<Vec3> residual(residuals);
  residual = root_information_ * off;
  if (jacobians == nullptr) return true;
  ByPlaces by = by_places(base_from_map, way, scale);
  by.to.topRightCorner<2, 2>() = turn * aside_by_lean / scale;
  by.from.topRightCorner<2, 2>() = -aside_by_lean / scale;
  Vec3 by_scale;
  by_scale << -seen / scale, 0.0;
  Eigen::Matrix3d by_mount = Eigen::Matrix3d::Zero();
  by_mount.topLeftCorner<2, 2>() = -sweep / scale;
  Eigen::Matrix3d by_turn = Eigen::Matrix3d::Zero();
  by_turn.topLeftCorner<2, 1>() = sweep * Vec2(0.0, print * above_camera_m_) / scale;
  by_turn.block<2, 1>(0, 1) = -sweep * Vec2(print * above_camera_m_, 0.0) / scale;
  by_turn.col(2) << camera_way.y(), -camera_way.x(), 0.0;
  Eigen::Matrix<double, 3, 2> by_print = Eigen::Matrix<double, 3, 2>::Zero();
  by_print.topLeftCorner<2, 1>() = (swayed / print - sweep * aside_by_print_m) / scale;
  write(root_information_ * by.from, 0, 5, jacobians[0]);
  write(root_information_ * by.to, 0, 5, jacobians[1]);
  write(root_information_ * by_scale, 0, 1, jacobians[2]);
  write(root_information_ * by_mount, 0, 3, jacobians[3]);
  write(root_information_ * by_turn, 0, 3, jacobians[4]);
  write(root_information_ * by_print, 0, 2, jacobians[5]);
  return true;
}

Near::Near(int size, int first, Eigen::VectorXd mean, const Eigen::VectorXd& sigmas)
    : size_(size), first_(first), mean_(std::move(mean)), weights_(sigmas.cwiseInverse()) {
  set_num_residuals(static_cast<int>(mean_.size()));
  *mutable_parameter_block_sizes() = {size};
}

bool Near::Evaluate(const double* const* parameters, double* residuals, double** jacobians) const {
  const Eigen::Index count = mean_.size();
  const Eigen::Map<const Eigen::VectorXd> at(parameters[0] + first_, count);
  Eigen::Map<Eigen::VectorXd>(residuals, count) = weights_.cwiseProduct(at - mean_);
  if (jacobians == nullptr) return true;
  Eigen::MatrixXd by = Eigen::MatrixXd::Zero(count, size_);
  by.middleCols(first_, count) = weights_.asDiagonal();
  write(by, 0, size_, jacobians[0]);
  return true;
}

PoseNear::PoseNear(const Known& known, int size, int yaw_at) : known_(known), size_(size), yaw_at_(yaw_at) {
  set_num_residuals(known.yaw ? 3 : 2);
  *mutable_parameter_block_sizes() = {size};
}

bool PoseNear::Evaluate(const double* const* parameters, double* residuals, double** jacobians) const {
  const double yaw = parameters[0][yaw_at_];
  const Vec2 lever = Eigen::Rotation2Dd(yaw) * known_.from_block.position_m;
  const Vec2 at = Vec2(parameters[0][0], parameters[0][1]) + lever;
  Eigen::Map<Vec2> off(residuals);
  off = (at - known_.position_m) / known_.sigma_m;
  if (known_.yaw)
    residuals[2] = wrapped(yaw + known_.from_block.yaw_rad - known_.yaw->yaw_rad) / known_.yaw->sigma_rad;
  if (jacobians == nullptr) return true;
  Eigen::MatrixXd by = Eigen::MatrixXd::Zero(num_residuals(), size_);
  by.topLeftCorner<2, 2>().setIdentity();
  by.block<2, 1>(0, yaw_at_) = Vec2(-lever.y(), lever.x());
  by.topRows<2>() /= known_.sigma_m;
  if (known_.yaw) by(2, yaw_at_) = 1.0 / known_.yaw->sigma_rad;
  write(by, 0, size_, jacobians[0]);
  return true;
}

bool MarkersApart::Evaluate(const double* const* parameters, double* residuals, double** jacobians) const {
  const Vec3 way = Eigen::Map<const Vec3>(parameters[1]) - Eigen::Map<const Vec3>(parameters[0]);
  const double distance_m = way.norm();
  if (!(distance_m > 0.0)) return false;
  residuals[0] = (distance_m - distance_m_) / sigma_m_;
  if (jacobians == nullptr) return true;
  Eigen::Matrix<double, 1, 6> by = Eigen::Matrix<double, 1, 6>::Zero();
  by.leftCols<3>() = way.transpose() / (distance_m * sigma_m_);
  write(-by, 0, 6, jacobians[0]);
  write(by, 0, 6, jacobians[1]);
  return true;
}

}  // namespace lodestar
