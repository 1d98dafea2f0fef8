#pragma once

#include <vector>

#include "control/field_options.hpp"
#include "maps/motion.hpp"
#include "maps/robot_shape.hpp"

namespace lodestar {

/// Where the robot would come to rest: at `wanted` until a braking command takes effect, then braking.
class BrakingPath {
 public:
  /// Between two times; the outline stays within `sway_m` of where it is at `middle`.
  struct Step {
    double until_s = 0.0;
    double speed_mps = 0.0;  ///< the outline's greatest, at the beginning
    Pose2 middle;            ///< base_now_from_base halfway
    Pose2 end;
    double sway_m = 0.0;
  };

  BrakingPath(const BodyVelocity& measured, const BodyVelocity& wanted, const RobotShape& shape,
              const ProtectiveFieldOptions& options);

  /// None when the outline does not move.
  [[nodiscard]] const std::vector<Step>& steps() const { return steps_; }

  [[nodiscard]] double until_rest_s() const { return steps_.empty() ? 0.0 : steps_.back().until_s; }

  /// No point of the outline goes farther.
  [[nodiscard]] double travel_m() const { return travel_m_; }

  /// When braking begins.
  [[nodiscard]] double speed_mps() const { return speed_mps_; }

  /// Is a turn on the spot wanted? Then what it drives is noise.
  [[nodiscard]] bool is_turn() const { return is_turn_; }

 private:
  std::vector<Step> steps_;
  double travel_m_ = 0.0;
  double speed_mps_ = 0.0;
  bool is_turn_ = false;
};

/// The greatest speed of the outline's points. A disc that turns keeps its place, but its rim rubs along
/// whoever touches it, and no base turns exactly on the spot: the faster of its centre and of its rim.
double outline_speed_mps(const BodyVelocity& velocity, const RobotShape& shape);

}  // namespace lodestar
