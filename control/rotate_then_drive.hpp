#pragma once

#include <optional>
#include <string_view>

#include "control/corner.hpp"
#include "control/drive_options.hpp"
#include "control/speed_limit.hpp"
#include "maps/motion.hpp"

namespace lodestar {

enum class DrivePhase { rotating, driving, passing_corner, final_rotation, arrived };
std::string_view to_string(DrivePhase phase);

/// The paper's closed loop (section 6.3): rotate towards the next waypoint (Eq. (18), with atan2 and
/// wrapped), drive straight until the distance is within epsilon (Eq. (19)), correcting heading and
/// cross-track error on the way; at the end turn to the final heading. Gentle corners may be passed without
/// stopping. A value type; its state is the leg, the phase, the last command and the commanded motion not yet
/// executed.
class RotateThenDrive {
 public:
  RotateThenDrive(Path path, std::optional<double> final_heading_rad, const DriveOptions& options = {});

  /// The velocity to command now. Call at a steady rate; `elapsed` since the last call bounds the change of
  /// speed.
  BodyVelocity update(const PoseEstimate& estimate, Duration elapsed, const SpeedLimit& limit = {});

  /// The velocity that brakes the robot to rest within the acceleration limits; keeps the path.
  BodyVelocity slow_down(Duration elapsed);

  /// The velocity that brakes to rest, then turns on the spot to look for markers; keeps the path.
  BodyVelocity turn_around(double turn_radps, Duration elapsed);

  /// The velocity nearest to the wanted one within the acceleration limits; keeps the path.
  BodyVelocity steer(const BodyVelocity& wanted, Duration elapsed);

  /// Another velocity was sent in place of the last one, such as a protective field allows: the speed goes on
  /// from there.
  void was_sent(const BodyVelocity& sent, Duration elapsed);

  /// Goes on along these waypoints, the first of which is the present end, and to this final heading. With
  /// `passes_end` the leg to that end goes straight on to the second. Call before arrived().
  void extend(const Path& tail, bool passes_end, std::optional<double> final_heading_rad,
              double blend_corridor_m);

  /// Takes over the other's last command and pending motion, so that the speed does not jump.
  void take_over_from(const RotateThenDrive& other);

  [[nodiscard]] DrivePhase phase() const { return phase_; }
  /// The path is driven to its end: to within epsilon of the goal, or as near as several approaches came.
  [[nodiscard]] bool arrived() const { return phase_ == DrivePhase::arrived; }

  /// The command is zero, and hardly any commanded motion is pending.
  [[nodiscard]] bool at_rest() const;

  /// The leg being driven, from its beginning, and those after it; empty when there is none.
  [[nodiscard]] Path path_ahead() const;

  [[nodiscard]] const std::optional<double>& final_heading_rad() const { return final_heading_rad_; }

 private:
  void next_phase(const Pose2& pose);
  void next_phase_rotating(const Pose2& pose);
  void next_phase_driving(const Pose2& pose);
  void next_phase_passing(const Pose2& pose);
  void next_leg();
  void begin_turn();
  void end_leg(const Pose2& pose);
  void next_phase_final(const Pose2& pose);

  [[nodiscard]] BodyVelocity turn_to(double heading_rad, double done_rad, const Pose2& pose,
                                     const SpeedLimit& limit) const;
  [[nodiscard]] BodyVelocity drive_leg(const Pose2& pose, const SpeedLimit& limit) const;
  [[nodiscard]] BodyVelocity pass_corner(const Pose2& pose, const SpeedLimit& limit) const;
  [[nodiscard]] double steered(double wanted_heading_rad, const Pose2& pose) const;
  [[nodiscard]] std::optional<Corner> corner_ahead() const;
  BodyVelocity command(const BodyVelocity& wanted, Duration elapsed);
  [[nodiscard]] bool on_last_leg() const { return target_ + 1 >= path_.waypoints_m.size(); }
  [[nodiscard]] const Vec2& target_m() const { return path_.waypoints_m[target_]; }
  [[nodiscard]] double epsilon_m() const;
  [[nodiscard]] double remaining_m(const Pose2& pose) const;
  [[nodiscard]] double leg_heading_rad() const;

  Path path_;
  std::optional<double> final_heading_rad_;
  DriveOptions options_;
  DrivePhase phase_ = DrivePhase::rotating;
  std::size_t target_ = 0;  ///< index of the waypoint driven to
  Vec2 leg_start_m_ = Vec2::Zero();
  std::optional<double> turn_heading_rad_;  ///< fixed when a turn to a waypoint begins
  std::optional<Corner> corner_;            ///< at the target, if it is passed without stopping
  int approaches_ = 0;                      ///< to the goal
  BodyVelocity last_;
  double pending_m_ = 0.0;    ///< distance commanded but not yet travelled
  double pending_rad_ = 0.0;  ///< likewise the rotation
};

}  // namespace lodestar
