#include "localization/calibration/mount_bundle.hpp"

#include <Eigen/SparseCholesky>
#include <cmath>
#include <limits>

namespace lodestar {
namespace {

constexpr std::size_t place_unknowns = 5;  // x, y, yaw, two of wobble
constexpr int not_an_unknown = -1;
constexpr double least_sideways_m = 1e-4;  ///< what a step's arc leaves out

Eigen::Matrix3d rotation_by(const Vec3& vector) {
  const double angle = vector.norm();
  return angle > 0.0 ? Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix()
                     : Eigen::Matrix3d::Identity();
}

Eigen::Matrix3d heading(double yaw_rad) {
  return Eigen::AngleAxisd(yaw_rad, Vec3::UnitZ()).toRotationMatrix();
}

/// Where each unknown stands in the normal equations: the frames' places first, then what they share.
class Numbering {
 public:
  Numbering(std::size_t frames, const std::array<bool, mount_unknowns>& fixed) {
    size_ = static_cast<int>(frames * place_unknowns);
    for (std::size_t i = 0; i < mount_unknowns; ++i) shared_[i] = fixed[i] ? not_an_unknown : size_++;
  }
  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] int shared(std::size_t unknown) const { return shared_[unknown]; }
  [[nodiscard]] static int place(std::size_t frame, std::size_t unknown) {
    return static_cast<int>(frame * place_unknowns + unknown);
  }

 private:
  std::array<int, mount_unknowns> shared_{};
  int size_ = 0;
};

/// Sums up J'J, J'r and r'r from rows that each touch a few unknowns.
class NormalEquations {
 public:
  explicit NormalEquations(int size) : gradient(Eigen::VectorXd::Zero(size)) {}

  template <int Rows, int Columns>
  void add(const std::array<int, static_cast<std::size_t>(Columns)>& unknowns,
           const Eigen::Matrix<double, Rows, Columns>& jacobian,
           const Eigen::Matrix<double, Rows, 1>& residual) {
    cost += residual.squaredNorm();
    rows += Rows;
    for (int i = 0; i < Columns; ++i) {
      const int row = unknowns[static_cast<std::size_t>(i)];
      if (row == not_an_unknown) continue;
      gradient[row] += jacobian.col(i).dot(residual);
      for (int j = 0; j < Columns; ++j) {
        const int column = unknowns[static_cast<std::size_t>(j)];
        if (column != not_an_unknown && column <= row)
          entries.emplace_back(row, column, jacobian.col(i).dot(jacobian.col(j)));
      }
    }
  }

  std::vector<Eigen::Triplet<double>> entries;  ///< lower half
  Eigen::VectorXd gradient;
  double cost = 0.0;
  double dot_cost = 0.0;    ///< the dots' part of it
  double wheel_cost = 0.0;  ///< the wheels' part
  int rows = 0;
  int dot_rows = 0;
  int wheel_rows = 0;
};

/// How the camera's pose (translation, rotation about the map's axes) moves with a frame's place and the
/// mount: map_from_camera = place * wobble * mount.
struct CameraPose {
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
  Eigen::Matrix<double, 6, 11> jacobian = Eigen::Matrix<double, 6, 11>::Zero();
};

CameraPose camera_pose(const MountState& state, const BasePlace& place) {
  const Eigen::Matrix3d turned = heading(place.yaw_rad);
  const Eigen::Matrix3d map_from_body =
      turned * rotation_by({place.wobble_rad.x(), place.wobble_rad.y(), 0.0});
  const Vec3 lever = map_from_body * state.position_m;
  CameraPose pose;
  pose.map_from_camera.translation() = lever + Vec3(place.position_m.x(), place.position_m.y(), 0.0);
  pose.map_from_camera.linear() = map_from_body * state.base_from_camera;
  const auto turn = [&](int column, const Vec3& axis) {
    pose.jacobian.col(column) << axis.cross(lever), axis;
  };
  pose.jacobian.topLeftCorner<2, 2>().setIdentity();
  turn(2, Vec3::UnitZ());
  turn(3, turned.col(0));
  turn(4, turned.col(1));
  pose.jacobian.block<3, 3>(0, 5) = map_from_body;
  pose.jacobian.block<3, 3>(3, 8) = map_from_body;
  return pose;
}

/// False when a dot lies behind the camera.
bool add_dots(const MountProblem& problem, const MountState& state, const Numbering& numbering,
              std::size_t frame, NormalEquations& sum) {
  const CameraPose pose = camera_pose(state, state.places[frame]);
  std::array<int, 11> unknowns{};
  for (std::size_t i = 0; i < place_unknowns; ++i) unknowns[i] = Numbering::place(frame, i);
  for (std::size_t i = 0; i < 6; ++i) unknowns[place_unknowns + i] = numbering.shared(at_x + i);
  const double cost_before = sum.cost;
  for (const SurveyedDot& dot : problem.frames[frame].dots) {
    const auto seen = project_dot(pose.map_from_camera, dot.point_in_map, problem.camera);
    if (!seen) return false;
    const double weight = 1.0 / problem.options.dot_sigma_px;
    const Eigen::Matrix<double, 2, 11> jacobian = weight * seen->jacobian * pose.jacobian;
    sum.add<2, 11>(unknowns, jacobian, weight * (seen->pixel - dot.center_px));
    sum.dot_rows += 2;
  }
  sum.dot_cost += sum.cost - cost_before;
  return true;
}

/// The wheels between two frames roll an arc; what is left over is slip, in the base's directions half-way.
void add_wheels(const MountProblem& problem, const MountState& state, const Numbering& numbering,
                std::size_t frame, NormalEquations& sum) {
  const MountFrame& before = problem.frames[frame];
  const MountFrame& after = problem.frames[frame + 1];
  const BasePlace& from = state.places[frame];
  const BasePlace& to = state.places[frame + 1];
  const double left_m = after.left_m - before.left_m;
  const double right_m = after.right_m - before.right_m;
  const double forward_m = 0.5 * (state.left_scale * left_m + state.right_scale * right_m);
  const double turn_rad = (state.right_scale * right_m - state.left_scale * left_m) / state.track_width_m;
  const double half = 0.5 * turn_rad;
  const double chord = std::abs(half) > 1e-6 ? std::sin(half) / half : 1.0;

  const double middle = from.yaw_rad + 0.5 * wrap_angle(to.yaw_rad - from.yaw_rad);
  const Eigen::Rotation2Dd base_from_map(-middle);
  const Vec2 moved = base_from_map * (to.position_m - from.position_m);
  Vec3 residual(moved.x() - chord * forward_m, moved.y(), wrap_angle(to.yaw_rad - from.yaw_rad - turn_rad));

  Eigen::Matrix<double, 3, 9> jacobian = Eigen::Matrix<double, 3, 9>::Zero();
  const Vec2 by_middle(moved.y(), -moved.x());
  jacobian.block<2, 2>(0, 0) = -base_from_map.toRotationMatrix();
  jacobian.block<2, 2>(0, 3) = base_from_map.toRotationMatrix();
  jacobian.block<2, 1>(0, 2) = 0.5 * by_middle;
  jacobian.block<2, 1>(0, 5) = 0.5 * by_middle;
  jacobian(2, 2) = -1.0;
  jacobian(2, 5) = 1.0;
  jacobian.col(6) << -0.5 * chord * left_m, 0.0, left_m / state.track_width_m;
  jacobian.col(7) << -0.5 * chord * right_m, 0.0, -right_m / state.track_width_m;
  jacobian.col(8) << 0.0, 0.0, turn_rad / state.track_width_m;

  const MountCalibrationOptions& options = problem.options;
  const double root_m = std::sqrt(0.5 * (std::abs(left_m) + std::abs(right_m)));
  const double along_m = std::hypot(options.encoder_sigma_m, options.slip_sigma_per_sqrt_m * root_m);
  const double sideways_m = std::hypot(least_sideways_m, options.sideways_sigma_per_sqrt_m * root_m);
  const Vec3 weight(1.0 / along_m, 1.0 / sideways_m, state.track_width_m / (std::numbers::sqrt2 * along_m));
  const std::array<int, 9> unknowns{
      Numbering::place(frame, 0),     Numbering::place(frame, 1),     Numbering::place(frame, 2),
      Numbering::place(frame + 1, 0), Numbering::place(frame + 1, 1), Numbering::place(frame + 1, 2),
      numbering.shared(left_scale),   numbering.shared(right_scale),  numbering.shared(track)};
  residual = residual.cwiseProduct(weight);
  sum.add<3, 9>(unknowns, weight.asDiagonal() * jacobian, residual);
  sum.wheel_cost += residual.squaredNorm();
  sum.wheel_rows += 3;
}

/// What is believed of wobble and wheels before looking.
void add_beliefs(const MountProblem& problem, const MountState& state, const Numbering& numbering,
                 NormalEquations& sum) {
  const auto add = [&sum](int unknown, double value, double sigma) {
    sum.add<1, 1>({unknown}, Eigen::Matrix<double, 1, 1>(1.0 / sigma),
                  Eigen::Matrix<double, 1, 1>(value / sigma));
  };
  constexpr double least_wobble_rad = 1e-4;  // no floor is flatter
  const double wobble_rad = std::max(problem.belief.wobble_sigma_rad, least_wobble_rad);
  for (std::size_t frame = 0; frame < state.places.size(); ++frame) {
    add(Numbering::place(frame, 3), state.places[frame].wobble_rad.x(), wobble_rad);
    add(Numbering::place(frame, 4), state.places[frame].wobble_rad.y(), wobble_rad);
  }
  const double scale = problem.options.wheel_scale_sigma;
  const double track_width_m = problem.belief.track_width_m;
  add(numbering.shared(left_scale), state.left_scale - 1.0, scale);
  add(numbering.shared(right_scale), state.right_scale - 1.0, scale);
  add(numbering.shared(track), state.track_width_m - track_width_m, scale * track_width_m);
}

std::optional<NormalEquations> equations(const MountProblem& problem, const MountState& state,
                                         const Numbering& numbering) {
  NormalEquations sum(numbering.size());
  for (std::size_t frame = 0; frame < problem.frames.size(); ++frame) {
    if (!add_dots(problem, state, numbering, frame, sum)) return std::nullopt;
    if (frame + 1 < problem.frames.size()) add_wheels(problem, state, numbering, frame, sum);
  }
  add_beliefs(problem, state, numbering, sum);
  return sum;
}

MountState moved_by(const Eigen::VectorXd& step, const MountState& state, const Numbering& numbering) {
  const auto shared = [&](std::size_t unknown) {
    const int at = numbering.shared(unknown);
    return at == not_an_unknown ? 0.0 : step[at];
  };
  MountState moved = state;
  moved.position_m += Vec3(shared(at_x), shared(at_y), shared(at_z));
  moved.base_from_camera =
      rotation_by({shared(about_x), shared(about_y), shared(about_z)}) * state.base_from_camera;
  moved.left_scale += shared(left_scale);
  moved.right_scale += shared(right_scale);
  moved.track_width_m += shared(track);
  for (std::size_t frame = 0; frame < moved.places.size(); ++frame) {
    const auto d = step.segment<place_unknowns>(Numbering::place(frame, 0));
    moved.places[frame].position_m += d.head<2>();
    moved.places[frame].yaw_rad = wrap_angle(moved.places[frame].yaw_rad + d[2]);
    moved.places[frame].wobble_rad += d.tail<2>();
  }
  return moved;
}

using Sparse = Eigen::SparseMatrix<double>;
using Cholesky = Eigen::SimplicialLDLT<Sparse, Eigen::Lower>;

Sparse matrix_of(const NormalEquations& sum) {
  Sparse matrix(sum.gradient.size(), sum.gradient.size());
  matrix.setFromTriplets(sum.entries.begin(), sum.entries.end());
  return matrix;
}

/// The shared unknowns' block of the inverse. What the log says nothing about gets a deviation of about 1 (m
/// or rad) instead of infinity.
Eigen::Matrix<double, 9, 9> shared_covariance(const NormalEquations& sum, const Numbering& numbering) {
  Sparse matrix = matrix_of(sum);
  for (std::size_t i = 0; i < mount_unknowns; ++i) {
    const int at = numbering.shared(i);
    if (at != not_an_unknown) matrix.coeffRef(at, at) += 1.0;
  }
  const Cholesky factors(matrix);
  const double noise = std::max(1.0, sum.cost / std::max(1, sum.rows - numbering.size()));
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
  for (std::size_t j = 0; j < mount_unknowns; ++j) {
    if (numbering.shared(j) == not_an_unknown) continue;
    const Eigen::VectorXd column =
        factors.solve(Eigen::VectorXd::Unit(numbering.size(), numbering.shared(j)));
    for (std::size_t i = 0; i < mount_unknowns; ++i) {
      if (numbering.shared(i) == not_an_unknown) continue;
      covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          noise * column[numbering.shared(i)];
    }
  }
  return covariance;
}

}  // namespace

std::optional<MountSolution> solve_mount(const MountProblem& problem, const MountState& start) {
  const Numbering numbering(problem.frames.size(), problem.fixed);
  MountState state = start;
  std::optional<NormalEquations> sum = equations(problem, state, numbering);
  if (!sum) return std::nullopt;
  double damping = 1e-4;
  constexpr double most_damping = 1e8;
  constexpr int enough = 60;
  for (int iteration = 0; iteration < enough && damping < most_damping; ++iteration) {
    Sparse damped = matrix_of(*sum);
    damped.diagonal() *= 1.0 + damping;
    const Cholesky factors(damped);
    if (factors.info() != Eigen::Success) return std::nullopt;
    const MountState moved = moved_by(-factors.solve(sum->gradient), state, numbering);
    std::optional<NormalEquations> next = equations(problem, moved, numbering);
    if (!next || !(next->cost < sum->cost)) {
      damping *= 10.0;
      continue;
    }
    const bool settled = sum->cost - next->cost < 1e-7 * sum->cost;
    state = moved;
    sum = std::move(next);
    damping *= 0.1;
    if (settled) break;
  }
  return MountSolution{.state = state,
                       .covariance = shared_covariance(*sum, numbering),
                       .dot_rms_px = problem.options.dot_sigma_px *
                                     std::sqrt(2.0 * sum->dot_cost / std::max(1, sum->dot_rows)),
                       .wheel_rms = std::sqrt(sum->wheel_cost / std::max(1, sum->wheel_rows))};
}

}  // namespace lodestar
