#pragma once

#include <optional>
#include <string_view>

#include "maps/motion.hpp"

namespace lodestar {

struct DriveOptions {
  double max_forward_mps = 0.6;
  double max_turn_radps = 1.2;
  double max_acceleration_mps2 = 0.5;
  double max_turn_acceleration_radps2 = 2.0;
  double max_wheel_mps = 0.8;
  double track_width_m = 0.4;
  double min_forward_mps = 0.02;  ///< slower, real motors stand still
  double min_turn_radps = 0.06;   ///< likewise
  double response_s = 0.12;       ///< from a command to its effect: lag and latency of the base
  double braking_share = 0.8;     ///< of the acceleration, that braking at the end of a leg is planned with
  double arrival_distance_m = 0.01;           ///< epsilon of Eq. (19), at the goal
  double waypoint_distance_m = 0.02;          ///< epsilon at the waypoints between
  double arrival_heading_rad = radians(1.0);  ///< of the final heading, when one is wanted
  double turn_done_rad = radians(1.0);        ///< rotation before a leg ends here
  double turn_again_rad = radians(20.0);  ///< a leg's heading error from which the robot stops to rotate anew
  double heading_gain_per_s = 2.5;        ///< heading correction while driving
  double lateral_gain_per_m = 2.5;        ///< heading wanted towards the leg, per metre beside it
  double passed_distance_m = 0.015;       ///< not worth turning back to a goal passed this near
  int max_approaches = 4;  ///< tries at the goal's epsilon before coming this near counts as arrival
};

enum class DrivePhase { rotating, driving, final_rotation, arrived };
std::string_view to_string(DrivePhase phase);

/// The paper's closed loop (section 6.3): rotate towards the next waypoint (Eq. (18), with atan2 and
/// wrapped), drive straight until the distance is within epsilon (Eq. (19)), correcting heading and lateral
/// error on the way; at the end turn to the final heading. A value type whose state is which leg, which
/// phase, the last command and what of the commands is still to come into effect.
class RotateThenDrive {
 public:
  RotateThenDrive(Path path, std::optional<double> final_heading_rad, const DriveOptions& options = {});

  /// The velocity to command now. Called at a steady rate; `elapsed` since the last call bounds the change of
  /// speed.
  BodyVelocity update(const PoseEstimate& estimate, Duration elapsed);

  /// The velocity that brings the robot to rest within the acceleration limits; forgets nothing of the path.
  BodyVelocity slow_down(Duration elapsed);

  [[nodiscard]] DrivePhase phase() const { return phase_; }
  [[nodiscard]] bool arrived() const { return phase_ == DrivePhase::arrived; }

 private:
  void next_phase(const Pose2& pose);
  void next_phase_rotating(const Pose2& pose);
  void next_phase_driving(const Pose2& pose);
  void begin_turn();
  void end_leg(const Pose2& pose);
  void next_phase_final(const Pose2& pose);

  [[nodiscard]] BodyVelocity turn_to(double heading_rad, double done_rad, const Pose2& pose) const;
  [[nodiscard]] BodyVelocity drive_leg(const Pose2& pose) const;
  BodyVelocity command(const BodyVelocity& wanted, Duration elapsed);
  [[nodiscard]] bool at_rest() const;
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
  int approaches_ = 0;                      ///< to the goal
  BodyVelocity last_;
  double pending_m_ = 0.0;    ///< way that was commanded and has not come into effect yet
  double pending_rad_ = 0.0;  ///< likewise of turns
};

}  // namespace lodestar
