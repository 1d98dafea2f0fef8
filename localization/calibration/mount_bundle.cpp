#include "localization/calibration/mount_bundle.hpp"

#include <Eigen/Geometry>
#include <ceres/autodiff_cost_function.h>
#include <ceres/covariance.h>
#include <ceres/manifold.h>
#include <ceres/normal_prior.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <cmath>
#include <memory>
#include <numbers>

#include "maps/rotation_vector.hpp"

namespace lodestar {
namespace {

constexpr double least_sideways_m = 1e-4;  ///< deviation from a step's arc
constexpr double least_wobble_rad = 1e-4;  ///< no floor is flatter

/// A frame's unknowns: x, y, yaw and two of wobble.
using Place = Eigen::Matrix<double, 5, 1>;

/// All unknowns as Ceres has them. The mount rotates about the base's axes, starting at `base_from_camera`.
struct Unknowns {
  std::vector<Place> places;
  Vec3 position_m = Vec3::Zero();
  Vec3 turn_rad = Vec3::Zero();
  Vec3 wheels = Vec3::Ones();  ///< left scale, right scale, track width
  Eigen::Matrix3d base_from_camera = Eigen::Matrix3d::Identity();
};

/// Reprojection errors of one frame's dots, with map_from_camera = place * wobble * mount. Parameters: the
/// place, the mount's position and its turn.
class DotsOfFrame : public ceres::CostFunction {
 public:
  DotsOfFrame(const MountProblem& problem, const MountFrame& frame, const Unknowns& unknowns)
      : problem_(problem), frame_(frame), unknowns_(unknowns) {
    set_num_residuals(2 * static_cast<int>(frame.dots.size()));
    *mutable_parameter_block_sizes() = {5, 3, 3};
  }

  /// False when a dot is behind the camera.
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const CameraPose pose =
        camera_pose(Eigen::Map<const Place>(parameters[0]), Eigen::Map<const Vec3>(parameters[1]),
                    Eigen::Map<const Vec3>(parameters[2]));
    const double weight = 1.0 / problem_.options.dot_sigma_px;
    for (std::size_t i = 0; i < frame_.dots.size(); ++i) {
      const SurveyedDot& dot = frame_.dots[i];
      const auto seen = project_dot(pose.map_from_camera, dot.point_in_map, problem_.camera);
      if (!seen) return false;
      Eigen::Map<Vec2>(residuals + 2 * i) = weight * (seen->pixel - dot.center_px);
      if (jacobians == nullptr) continue;
      const Eigen::Matrix<double, 2, 11> by_all = weight * seen->jacobian * pose.by_unknowns;
      write<5>(by_all.leftCols<5>(), i, jacobians[0]);
      write<3>(by_all.middleCols<3>(5), i, jacobians[1]);
      write<3>(by_all.rightCols<3>(), i, jacobians[2]);
    }
    return true;
  }

 private:
  /// The derivative is that of the translation and of the rotation about the map's axes.
  struct CameraPose {
    Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
    Eigen::Matrix<double, 6, 11> by_unknowns = Eigen::Matrix<double, 6, 11>::Zero();
  };

  [[nodiscard]] CameraPose camera_pose(const Place& place, const Vec3& position_m,
                                       const Vec3& turn_rad) const {
    const Eigen::Matrix3d turned = rotation_by({0.0, 0.0, place[2]});
    const Eigen::Matrix3d map_from_body = turned * rotation_by({place[3], place[4], 0.0});
    const Vec3 lever = map_from_body * position_m;
    CameraPose pose;
    pose.map_from_camera.translation() = lever + Vec3(place.x(), place.y(), 0.0);
    pose.map_from_camera.linear() = map_from_body * rotation_by(turn_rad) * unknowns_.base_from_camera;
    const auto turn_about = [&](int column, const Vec3& axis) {
      pose.by_unknowns.col(column) << axis.cross(lever), axis;
    };
    pose.by_unknowns.topLeftCorner<2, 2>().setIdentity();
    turn_about(2, Vec3::UnitZ());
    const Eigen::Matrix3d by_wobble = turned * turn_by_vector({place[3], place[4], 0.0});
    turn_about(3, by_wobble.col(0));
    turn_about(4, by_wobble.col(1));
    pose.by_unknowns.block<3, 3>(0, 5) = map_from_body;
    pose.by_unknowns.block<3, 3>(3, 8) = map_from_body * turn_by_vector(turn_rad);
    return pose;
  }

  /// Two rows of one block's derivative, row-major as in Ceres; null for a constant block.
  template <int Columns>
  static void write(const Eigen::Matrix<double, 2, Columns>& rows, std::size_t dot, double* jacobian) {
    if (jacobian == nullptr) return;
    Eigen::Map<Eigen::Matrix<double, 2, Columns, Eigen::RowMajor>>(jacobian + 2 * dot * Columns) = rows;
  }

  const MountProblem& problem_;
  const MountFrame& frame_;
  const Unknowns& unknowns_;
};

/// Slip between two frames: their motion less the wheels' arc, in the base's axes at half the turn.
struct SlipBetweenFrames {
  double left_m = 0.0;  ///< rolled, as reported
  double right_m = 0.0;
  Vec3 weight;  ///< of the slip forward, sideways and in turn

  SlipBetweenFrames(const MountProblem& problem, const MountFrame& before, const MountFrame& after)
      : left_m(after.left_m - before.left_m), right_m(after.right_m - before.right_m) {
    const MountCalibrationOptions& options = problem.options;
    const double root_m = std::sqrt(0.5 * (std::abs(left_m) + std::abs(right_m)));
    const double along_m = std::hypot(options.encoder_sigma_m, options.slip_sigma_per_sqrt_m * root_m);
    const double sideways_m = std::hypot(least_sideways_m, options.sideways_sigma_per_sqrt_m * root_m);
    weight = {1.0 / along_m, 1.0 / sideways_m,
              problem.belief.track_width_m / (std::numbers::sqrt2 * along_m)};
  }

  template <typename T>
  bool operator()(const T* from, const T* to, const T* wheels, T* slip) const {
    using std::abs, std::cos, std::sin;
    const T left = wheels[0] * left_m;
    const T right = wheels[1] * right_m;
    const T rolled_turn = (right - left) / wheels[2];
    const T half = 0.5 * rolled_turn;
    const T chord = abs(half) > 1e-6 ? T(sin(half) / half) : T(1.0);
    const T turn = wrapped(to[2] - from[2]);
    const T middle = from[2] + 0.5 * turn;
    const T dx = to[0] - from[0];
    const T dy = to[1] - from[1];
    slip[0] = weight[0] * (cos(middle) * dx + sin(middle) * dy - chord * 0.5 * (left + right));
    slip[1] = weight[1] * (cos(middle) * dy - sin(middle) * dx);
    slip[2] = weight[2] * wrapped(turn - rolled_turn);
    return true;
  }

 private:
  /// Wraps to -pi..pi.
  template <typename T>
  static T wrapped(const T& angle) {
    using std::floor;
    constexpr double whole = 2.0 * std::numbers::pi;
    return angle - whole * floor((angle + std::numbers::pi) / whole);
  }
};

/// Prior of some unknowns: `mean`, with their standard deviations. Ceres owns it.
template <int Rows, int Columns>
ceres::CostFunction* belief_of(const Eigen::Matrix<double, Rows, Columns>& which,
                               const Eigen::Matrix<double, Rows, 1>& sigmas, const Eigen::VectorXd& mean) {
  return new ceres::NormalPrior(sigmas.cwiseInverse().asDiagonal() * which, mean);
}

/// The least-squares problem, with its residual blocks by kind.
class Bundle {
 public:
  Bundle(const MountProblem& problem, const MountState& start) : problem_(problem) {
    unknowns_.position_m = start.position_m;
    unknowns_.base_from_camera = start.base_from_camera;
    unknowns_.wheels = {start.left_scale, start.right_scale, start.track_width_m};
    for (const BasePlace& place : start.places) {
      unknowns_.places.emplace_back(place.position_m.x(), place.position_m.y(), place.yaw_rad,
                                    place.wobble_rad.x(), place.wobble_rad.y());
    }
    add_dots();
    add_wheels();
    add_beliefs();
    keep_fixed(unknowns_.position_m, at_x);
    keep_fixed(unknowns_.turn_rad, about_x);
    keep_fixed(unknowns_.wheels, left_scale);
  }

  std::optional<MountSolution> solve() {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.max_num_iterations = 60;
    options.function_tolerance = 1e-10;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &ceres_, &summary);
    if (!summary.IsSolutionUsable()) return std::nullopt;
    // From here on the turn is relative to the solution, so that its covariance is about the base's axes.
    unknowns_.base_from_camera = rotation_by(unknowns_.turn_rad) * unknowns_.base_from_camera;
    unknowns_.turn_rad.setZero();
    const double freedom = std::max(1, summary.num_residuals - summary.num_effective_parameters);
    const double noise = std::max(1.0, 2.0 * summary.final_cost / freedom);
    const std::optional<Eigen::Matrix<double, 9, 9>> covariance = shared_covariance();
    if (!covariance) return std::nullopt;
    return MountSolution{.state = state(),
                         .covariance = noise * *covariance,
                         .dot_rms_px = problem_.options.dot_sigma_px * std::numbers::sqrt2 * rms_of(dots_),
                         .wheel_rms = rms_of(wheels_)};
  }

 private:
  void add_dots() {
    for (std::size_t i = 0; i < unknowns_.places.size(); ++i) {
      auto* const dots = new DotsOfFrame(problem_, problem_.frames[i], unknowns_);
      dots_.push_back(ceres_.AddResidualBlock(dots, nullptr, unknowns_.places[i].data(),
                                              unknowns_.position_m.data(), unknowns_.turn_rad.data()));
    }
  }

  void add_wheels() {
    for (std::size_t i = 0; i + 1 < unknowns_.places.size(); ++i) {
      auto* const slip = new ceres::AutoDiffCostFunction<SlipBetweenFrames, 3, 5, 5, 3>(
          new SlipBetweenFrames(problem_, problem_.frames[i], problem_.frames[i + 1]));
      wheels_.push_back(ceres_.AddResidualBlock(slip, nullptr, unknowns_.places[i].data(),
                                                unknowns_.places[i + 1].data(), unknowns_.wheels.data()));
    }
  }

  /// Priors of wobble and wheels.
  void add_beliefs() {
    const double wobble_rad = std::max(problem_.belief.wobble_sigma_rad, least_wobble_rad);
    Eigen::Matrix<double, 2, 5> wobble = Eigen::Matrix<double, 2, 5>::Zero();
    wobble.rightCols<2>().setIdentity();
    for (Place& place : unknowns_.places) {
      ceres_.AddResidualBlock(belief_of<2, 5>(wobble, Vec2(wobble_rad, wobble_rad), Place::Zero()), nullptr,
                              place.data());
    }
    const double track_width_m = problem_.belief.track_width_m;
    const Vec3 sigmas = problem_.options.wheel_scale_sigma * Vec3(1.0, 1.0, track_width_m);
    ceres_.AddResidualBlock(
        belief_of<3, 3>(Eigen::Matrix3d::Identity(), sigmas, Vec3(1.0, 1.0, track_width_m)), nullptr,
        unknowns_.wheels.data());
  }

  void keep_fixed(Vec3& block, std::size_t first) {
    std::vector<int> fixed;
    for (int i = 0; i < 3; ++i)
      if (problem_.fixed[first + static_cast<std::size_t>(i)]) fixed.push_back(i);
    if (fixed.size() == 3)
      ceres_.SetParameterBlockConstant(block.data());
    else if (!fixed.empty())
      ceres_.SetManifold(block.data(), new ceres::SubsetManifold(3, fixed));
  }

  /// Zero where fixed. What the log does not determine gets a standard deviation of about 1 (m or rad)
  /// instead of infinity.
  std::optional<Eigen::Matrix<double, 9, 9>> shared_covariance() {
    const std::vector<double*> shared{unknowns_.position_m.data(), unknowns_.turn_rad.data(),
                                      unknowns_.wheels.data()};
    for (double* const block : shared) {
      const Vec3 here = Eigen::Map<const Vec3>(block);
      ceres_.AddResidualBlock(belief_of<3, 3>(Eigen::Matrix3d::Identity(), Vec3::Ones(), here), nullptr,
                              block);
    }
    const std::vector<const double*> blocks(shared.begin(), shared.end());
    ceres::Covariance covariance({});
    Eigen::Matrix<double, 9, 9, Eigen::RowMajor> values;
    if (!covariance.Compute(blocks, &ceres_) || !covariance.GetCovarianceMatrix(blocks, values.data()))
      return std::nullopt;
    return values;
  }

  /// In standard deviations.
  double rms_of(const std::vector<ceres::ResidualBlockId>& blocks) {
    ceres::Problem::EvaluateOptions options;
    options.residual_blocks = blocks;
    double cost = 0.0;  // Ceres halves the sum of squares
    std::vector<double> residuals;
    if (blocks.empty() || !ceres_.Evaluate(options, &cost, &residuals, nullptr, nullptr)) return 0.0;
    return std::sqrt(2.0 * cost / static_cast<double>(residuals.size()));
  }

  [[nodiscard]] MountState state() const {
    MountState state{.position_m = unknowns_.position_m,
                     .base_from_camera = unknowns_.base_from_camera,
                     .left_scale = unknowns_.wheels[0],
                     .right_scale = unknowns_.wheels[1],
                     .track_width_m = unknowns_.wheels[2],
                     .places = {}};
    for (const Place& place : unknowns_.places)
      state.places.push_back({place.head<2>(), wrap_angle(place[2]), place.tail<2>()});
    return state;
  }

  const MountProblem& problem_;
  Unknowns unknowns_;
  ceres::Problem ceres_;
  std::vector<ceres::ResidualBlockId> dots_;
  std::vector<ceres::ResidualBlockId> wheels_;
};

}  // namespace

std::optional<MountSolution> solve_mount(const MountProblem& problem, const MountState& start) {
  return Bundle(problem, start).solve();
}

}  // namespace lodestar
