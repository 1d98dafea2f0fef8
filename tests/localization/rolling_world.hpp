#pragma once

#include <Eigen/Cholesky>
#include <cmath>

#include "localization/filter/pose_filter.hpp"
#include "maps/random.hpp"

// A robot with chosen errors of wheels and fixes, for the tests of the pose filter.
namespace lodestar::testing {

inline constexpr double track_m = 0.4;

inline Stamp at(double time_s) {
  return Stamp(from_seconds(time_s));
}

/// A robot whose wheels roll as commanded, and report slightly different travel.
struct World {
  Pose2 truth{{1.0, 2.0}, 0.3};
  WheelTravel reported;
  Vec2 scales = Vec2::Ones();  ///< true over reported
  double turn_scale = 1.0;     ///< track width as built over the true one
  double noise_m_per_sqrt_m = 0.0;
  double wheel_step_m = 0.0;
  double bias_sigma_m = 0.0;  ///< of the error that nearby fixes share
  double bias_sigma_rad = 0.0;
  Vec3 bias = Vec3::Zero();
  bool fixes_tell_bias = false;  ///< fixes state the shared covariance
  double sway_s = 0.0;           ///< correlation time of the errors of fixes
  Vec3 sway = Vec3::Zero();
  Stamp last_fix;
  Random random{1};

  /// The reported travel, rounded to `wheel_step_m`.
  [[nodiscard]] WheelTravel reading() const {
    if (wheel_step_m == 0.0) return reported;
    return {reported.stamp, wheel_step_m * std::round(reported.left_m / wheel_step_m),
            wheel_step_m * std::round(reported.right_m / wheel_step_m)};
  }

  static Vec3 variances(double sigma_m, double sigma_rad) {
    return {sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad};
  }

  [[nodiscard]] Vec3 fresh_bias() {
    return {bias_sigma_m * random.normal(), bias_sigma_m * random.normal(), bias_sigma_rad * random.normal()};
  }

  void roll(double left_m, double right_m, double time_s) {
    reported.stamp = at(time_s);
    reported.left_m += left_m;
    reported.right_m += right_m;
    const double left =
        left_m * scales[0] + noise_m_per_sqrt_m * std::sqrt(std::abs(left_m)) * random.normal();
    const double right =
        right_m * scales[1] + noise_m_per_sqrt_m * std::sqrt(std::abs(right_m)) * random.normal();
    const double turn = turn_scale * (right - left) / track_m;
    const double direction = truth.yaw_rad + 0.5 * turn;
    truth.position_m += 0.5 * (left + right) * Vec2(std::cos(direction), std::sin(direction));
    truth.yaw_rad = wrap_angle(truth.yaw_rad + turn);
    const double kept = std::exp(-0.5 * (std::abs(left_m) + std::abs(right_m)));  // correlation length of 1 m
    if (bias_sigma_m > 0.0) bias = kept * bias + std::sqrt(1.0 - kept * kept) * fresh_bias();
  }

  /// The error of the next fix, in sigmas: a first-order Gauss-Markov process.
  void sway_on() {
    const double kept = sway_s > 0.0 ? std::exp(-seconds(reported.stamp - last_fix) / sway_s) : 0.0;
    sway =
        kept * sway + std::sqrt(1.0 - kept * kept) * Vec3(random.normal(), random.normal(), random.normal());
    last_fix = reported.stamp;
  }

  PlanarFix fix(double sigma_m, double sigma_rad) {
    PlanarFix result{.stamp = reported.stamp, .map_from_base = truth};
    sway_on();
    result.map_from_base.position_m += bias.head<2>() + sigma_m * sway.head<2>();
    result.map_from_base.yaw_rad = wrap_angle(truth.yaw_rad + bias.z() + sigma_rad * sway.z());
    result.covariance = variances(sigma_m, sigma_rad).asDiagonal();
    if (fixes_tell_bias) {
      result.shared_covariance = variances(bias_sigma_m, bias_sigma_rad).asDiagonal();
      result.covariance += result.shared_covariance;
    }
    return result;
  }
};

inline PoseFilterOptions without_floor() {
  PoseFilterOptions options;
  options.track_width_m = track_m;
  options.fix_sigma_floor_m = 0.0;
  options.fix_sigma_floor_rad = 0.0;
  options.wheel_step_m = 0.0;
  options.fix_correlation = Duration::zero();
  return options;
}

/// Drives at 50 Hz along a gentle S, with a fix every fifth step while `sees`.
inline void drive(World& world, PoseFilter& filter, double from_s, double for_s, bool sees,
                  double sigma_m = 0.002, double sigma_rad = 0.002) {
  const int steps = static_cast<int>(std::lround(for_s * 50.0));
  for (int i = 1; i <= steps; ++i) {
    const double time_s = from_s + 0.02 * i;
    const double bend = 0.001 * std::sin(0.5 * time_s);
    world.roll(0.01 - bend, 0.01 + bend, time_s);
    filter.add_travel(world.reading());
    if (sees && i % 5 == 0) filter.add_fix(world.fix(sigma_m, sigma_rad));
  }
}

/// Normalized estimation error squared: chi-square with 3 degrees of freedom for a consistent filter.
inline double nees(const World& world, const Pose2& map_from_base, const Eigen::Matrix3d& covariance) {
  Vec3 error;
  error << world.truth.position_m - map_from_base.position_m,
      wrap_angle(world.truth.yaw_rad - map_from_base.yaw_rad);
  return error.dot(covariance.ldlt().solve(error));
}

inline double nees(const World& world, const PoseFilter& filter) {
  const PoseEstimate estimate = *filter.estimate();
  return nees(world, estimate.map_from_base, estimate.covariance);
}

inline double position_error(const World& world, const PoseFilter& filter) {
  return (filter.estimate()->map_from_base.position_m - world.truth.position_m).norm();
}

}  // namespace lodestar::testing
