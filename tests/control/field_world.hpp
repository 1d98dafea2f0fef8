#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <optional>
#include <vector>

#include "control/field_release.hpp"
#include "control/protective_field.hpp"
#include "maps/random.hpp"

// A plane without map or walls: a disc of a robot that follows its velocities late, and people as discs, seen
// by a scanner of 10 Hz as points of their outlines.
namespace lodestar {

struct Walker {
  Vec2 at_m = Vec2::Zero();
  Vec2 velocity_mps = Vec2::Zero();
  double radius_m = 0.25;
};

/// Follows each command after a dead time, with a limited deceleration: the base of the bench.
class ToyBase {
 public:
  ToyBase(double dead_time_s, double deceleration_mps2) : deceleration_(deceleration_mps2) {
    pipeline_.assign(static_cast<std::size_t>(std::lround(dead_time_s / tick_s)), BodyVelocity{});
  }

  static constexpr double tick_s = 0.005;

  void tick(const BodyVelocity& command) {
    pipeline_.push_back(command);
    const BodyVelocity wanted = pipeline_.front();
    pipeline_.pop_front();
    const auto towards = [](double is, double wants, double most) {
      return is + std::clamp(wants - is, -most, most);
    };
    const double most_mps =
        tick_s * (std::abs(wanted.forward_mps) < std::abs(velocity.forward_mps) ? deceleration_
                                                                                : 0.5 /* comfortable */);
    velocity.forward_mps = towards(velocity.forward_mps, wanted.forward_mps, most_mps);
    velocity.turn_radps = towards(velocity.turn_radps, wanted.turn_radps, 2.0 * tick_s);
    const double middle_rad = pose.yaw_rad + 0.5 * tick_s * velocity.turn_radps;
    pose.position_m += tick_s * velocity.forward_mps * Vec2(std::cos(middle_rad), std::sin(middle_rad));
    pose.yaw_rad += tick_s * velocity.turn_radps;
  }

  Pose2 pose;
  BodyVelocity velocity;

 private:
  double deceleration_;
  std::deque<BodyVelocity> pipeline_;
};

/// The points of a disc that the robot sees, 5 cm apart.
inline void add_outline(std::vector<FieldPoint>& points, const Walker& walker, const Vec2& seen_from_m,
                        Stamp stamp, Presence presence) {
  const double facing_rad = heading_between(walker.at_m, seen_from_m);
  const double step_rad = 0.05 / walker.radius_m;
  for (double turn_rad = -0.5 * std::numbers::pi; turn_rad <= 0.5 * std::numbers::pi; turn_rad += step_rad) {
    const double rad = facing_rad + turn_rad;
    points.push_back({stamp, walker.at_m + walker.radius_m * Vec2(std::cos(rad), std::sin(rad)), presence});
  }
}

/// The scan as it is delivered some time after it was complete.
struct Delivery {
  double at_s = 0.0;
  FieldScan scan;
};

}  // namespace lodestar
