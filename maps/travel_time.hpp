#pragma once

#include <cmath>
#include <optional>

#include "maps/motion.hpp"

namespace lodestar {

/// Time from rest to rest over a distance, with the time-optimal trapezoidal speed profile (triangular for
/// short distances). Planners ask for it millions of times: what the limits alone give is worked out once.
class TrapezoidTime {
 public:
  TrapezoidTime(double max_speed, double max_acceleration)
      : speed_(max_speed),
        acceleration_(max_acceleration),
        ramp_(max_speed / max_acceleration),
        ramps_distance_(max_speed * max_speed / max_acceleration) {}

  [[nodiscard]] double of(double distance) const {
    return distance < ramps_distance_ ? 2.0 * std::sqrt(distance / acceleration_) : distance / speed_ + ramp_;
  }

 private:
  double speed_;
  double acceleration_;
  double ramp_;            ///< time to full speed
  double ramps_distance_;  ///< of both ramps
};

/// Limits of a robot that turns on the spot and drives straight.
struct MotionLimits {
  double max_forward_mps = 0.6;
  double max_turn_radps = 1.2;
  double max_acceleration_mps2 = 0.5;
  double max_turn_acceleration_radps2 = 2.0;

  [[nodiscard]] TrapezoidTime leg_time() const { return {max_forward_mps, max_acceleration_mps2}; }
  [[nodiscard]] TrapezoidTime turn_time() const { return {max_turn_radps, max_turn_acceleration_radps2}; }
  [[nodiscard]] double leg_time_s(double length_m) const { return leg_time().of(length_m); }
  [[nodiscard]] double turn_time_s(double angle_rad) const {  ///< of either sign
    return turn_time().of(std::abs(angle_rad));
  }
};

/// Ideal time for the path: rest at every waypoint, turn on the spot, then drive straight to the next. Turns
/// from the start heading and to the goal heading are added where given.
double travel_time_s(const Path& path, std::optional<double> start_heading_rad,
                     std::optional<double> final_heading_rad, const MotionLimits& limits);

}  // namespace lodestar
