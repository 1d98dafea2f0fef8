#pragma once

#include <cmath>
#include <deque>

#include "control/differential_drive.hpp"
#include "maps/motion.hpp"
#include "maps/random.hpp"

namespace lodestar {

inline constexpr double period_s = 0.02;

/// A base with 80 ms of motor lag, 40 ms of latency by default, unequal wheel diameters, and a noisy pose.
struct Plant {
  Pose2 truth;
  WheelSpeeds wheels;
  std::deque<BodyVelocity> pending = std::deque<BodyVelocity>(2);
  Random random{1};
  double dead_band_mps = 0.0;  ///< a wheel commanded below this stands still

  PoseEstimate sensed() {
    PoseEstimate estimate;
    estimate.map_from_base = truth;
    estimate.map_from_base.position_m += 0.002 * Vec2(random.normal(), random.normal());
    estimate.map_from_base.yaw_rad = wrap_angle(truth.yaw_rad + radians(0.1) * random.normal());
    return estimate;
  }

  void run(const BodyVelocity& command) {
    pending.push_back(command);
    WheelSpeeds target = wheel_speeds(pending.front(), 0.4);
    if (std::abs(target.left_mps) < dead_band_mps) target.left_mps = 0.0;
    if (std::abs(target.right_mps) < dead_band_mps) target.right_mps = 0.0;
    pending.pop_front();
    for (int i = 0; i < 10; ++i) {
      constexpr double step_s = period_s / 10.0;
      wheels.left_mps += (target.left_mps - wheels.left_mps) * step_s / 0.08;
      wheels.right_mps += (target.right_mps - wheels.right_mps) * step_s / 0.08;
      const BodyVelocity v = body_velocity({1.006 * wheels.left_mps, 0.994 * wheels.right_mps}, 0.4);
      truth.position_m += v.forward_mps * step_s * Vec2(std::cos(truth.yaw_rad), std::sin(truth.yaw_rad));
      truth.yaw_rad = wrap_angle(truth.yaw_rad + v.turn_radps * step_s);
    }
  }
};

}  // namespace lodestar
