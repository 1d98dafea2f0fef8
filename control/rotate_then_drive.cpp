#include "control/rotate_then_drive.hpp"

#include <algorithm>
#include <cmath>

#include "control/differential_drive.hpp"

namespace lodestar {
namespace {

// Chosen by hand in simulated drives.
constexpr double waypoint_distance_m = 0.02;    ///< epsilon at intermediate waypoints
constexpr double turn_done_rad = radians(1.0);  ///< 2 cm cross-track error after 1 m, which steering corrects
/// Heading error on a leg at which the robot stops and turns again; driving on would be an arc.
constexpr double turn_again_rad = radians(20.0);
/// Heading correction while driving. With the base's response T = 0.12 s the loop of gain k has the damping
/// ratio 1 / (2 sqrt(k T)) = 0.9: hardly any overshoot.
constexpr double heading_gain_per_s = 2.5;
/// Heading correction towards the leg, per metre of cross-track error. At v = 0.6 m/s the time constant is
/// 1 / (v k) = 0.7 s, slower than the heading loop.
constexpr double lateral_gain_per_m = 2.5;
/// Tries to reach the goal within epsilon. The last one ends the drive at any distance: whoever sent the
/// robot decides what that means.
constexpr int most_approaches = 4;

/// The speed from which the distance is just enough to brake; never below the motors' dead band.
double approach_speed(double distance, double deceleration, double slowest, double fastest) {
  return std::clamp(std::sqrt(2.0 * deceleration * std::max(distance, 0.0)), slowest, fastest);
}

double stepped(double from, double to, double most) {
  return from + std::clamp(to - from, -most, most);
}

/// The travel still pending, one period of a command later, in a base with first-order lag. The total is
/// exact for any base: in the end it travels all that was commanded.
double pending_after(double pending, double command, double response_s, double elapsed_s) {
  const double kept = std::exp(-elapsed_s / std::max(response_s, 1e-3));
  return kept * pending + (1.0 - kept) * response_s * command;
}

/// Bounds the speed step after a gap between calls.
double bounded_s(Duration elapsed) {
  constexpr double longest_s = 0.1;
  return std::clamp(seconds(elapsed), 0.0, longest_s);
}

}  // namespace

std::string_view to_string(DrivePhase phase) {
  switch (phase) {
    case DrivePhase::rotating:
      return "rotating";
    case DrivePhase::driving:
      return "driving";
    case DrivePhase::passing_corner:
      return "passing a corner";
    case DrivePhase::final_rotation:
      return "turning to the final heading";
    case DrivePhase::arrived:
      return "arrived";
  }
  return "";
}

RotateThenDrive::RotateThenDrive(Path path, std::optional<double> final_heading_rad,
                                 const DriveOptions& options)
    : path_(std::move(path)), final_heading_rad_(final_heading_rad), options_(options) {
  if (path_.waypoints_m.empty()) {
    phase_ = DrivePhase::arrived;
    return;
  }
  leg_start_m_ = path_.waypoints_m.front();
  target_ = path_.waypoints_m.size() > 1 ? 1 : 0;
}

BodyVelocity RotateThenDrive::update(const PoseEstimate& estimate, Duration elapsed,
                                     const SpeedLimit& limit) {
  const Pose2& pose = estimate.map_from_base;
  next_phase(pose);
  BodyVelocity wanted;
  if (phase_ == DrivePhase::rotating) {
    if (turn_heading_rad_) wanted = turn_to(*turn_heading_rad_, turn_done_rad, pose, limit);
  } else if (phase_ == DrivePhase::driving) {
    wanted = drive_leg(pose, limit);
  } else if (phase_ == DrivePhase::passing_corner) {
    wanted = pass_corner(pose, limit);
  } else if (phase_ == DrivePhase::final_rotation) {
    wanted = turn_to(*final_heading_rad_, options_.arrival_heading_rad, pose, limit);
  }
  return command(wanted, elapsed);
}

BodyVelocity RotateThenDrive::slow_down(Duration elapsed) {
  return turn_around(0.0, elapsed);
}

BodyVelocity RotateThenDrive::turn_around(double turn_radps, Duration elapsed) {
  if (phase_ == DrivePhase::passing_corner) next_leg();  // does not return to the waypoint
  // Driving on begins with a turn to the target.
  if (phase_ != DrivePhase::arrived && phase_ != DrivePhase::final_rotation) begin_turn();
  const bool rolling = last_.forward_mps != 0.0;
  return command({0.0, rolling ? 0.0 : turn_radps}, elapsed);
}

BodyVelocity RotateThenDrive::steer(const BodyVelocity& wanted, Duration elapsed) {
  return command(wanted, elapsed);
}

/// pending_after() is linear in the command, so the difference is added for the last step.
void RotateThenDrive::was_sent(const BodyVelocity& sent, Duration elapsed) {
  const double elapsed_s = bounded_s(elapsed);
  pending_m_ += pending_after(0.0, sent.forward_mps - last_.forward_mps, options_.response_s, elapsed_s);
  pending_rad_ += pending_after(0.0, sent.turn_radps - last_.turn_radps, options_.response_s, elapsed_s);
  last_ = sent;
}

void RotateThenDrive::take_over_from(const RotateThenDrive& other) {
  last_ = other.last_;
  pending_m_ = other.pending_m_;
  pending_rad_ = other.pending_rad_;
}

/// A corner that is near already is not cut: the robot has slowed down to stop there.
void RotateThenDrive::extend(const Path& tail, bool passes_end, std::optional<double> final_heading_rad,
                             double blend_corridor_m) {
  if (tail.waypoints_m.size() < 2) return;
  if (passes_end) path_.waypoints_m.pop_back();
  path_.waypoints_m.insert(path_.waypoints_m.end(), tail.waypoints_m.begin() + 1, tail.waypoints_m.end());
  final_heading_rad_ = final_heading_rad;
  approaches_ = 0;
  if (phase_ == DrivePhase::final_rotation) begin_turn();
  if (phase_ != DrivePhase::passing_corner) options_.blend_corridor_m = blend_corridor_m;
}

void RotateThenDrive::next_phase(const Pose2& pose) {
  if (phase_ == DrivePhase::rotating) next_phase_rotating(pose);
  if (phase_ == DrivePhase::driving) next_phase_driving(pose);
  if (phase_ == DrivePhase::passing_corner) next_phase_passing(pose);
  if (phase_ == DrivePhase::final_rotation) next_phase_final(pose);
}

/// The heading to the target is fixed once, at rest: close to the target it changes with every millimetre of
/// noise, and the robot would chase it. From then on it drives, also where the target looks within epsilon
/// from that side: camera and markers are known to some millimetres, and from another it may look beyond
/// again. When the heading differs from the leg's by more than 10 degrees, the leg restarts at the robot;
/// else the robot would turn back and forth between the two headings.
void RotateThenDrive::next_phase_rotating(const Pose2& pose) {
  if (!at_rest()) return;
  if (!turn_heading_rad_) {
    if ((target_m() - pose.position_m).norm() <= epsilon_m()) {
      end_leg(pose);
      return;
    }
    turn_heading_rad_ = heading_between(pose.position_m, target_m());
    const double beside_rad = std::abs(wrap_angle(*turn_heading_rad_ - leg_heading_rad()));
    if (beside_rad > 0.5 * turn_again_rad) leg_start_m_ = pose.position_m;
  }
  const double error = wrap_angle(*turn_heading_rad_ - pose.yaw_rad);
  if (std::abs(error) > turn_done_rad) return;
  phase_ = DrivePhase::driving;
  corner_ = corner_ahead();
}

void RotateThenDrive::next_phase_driving(const Pose2& pose) {
  if (corner_ && remaining_m(pose) - pending_m_ <= corner_->cut_m) {
    phase_ = DrivePhase::passing_corner;
    return;
  }
  if (remaining_m(pose) <= 0.25 * epsilon_m() && at_rest()) {
    end_leg(pose);
    return;
  }
  // The leg's heading, as the direction to a close target is noise.
  const double error = wrap_angle(leg_heading_rad() - pose.yaw_rad);
  if (std::abs(error) > turn_again_rad) begin_turn();
}

/// The next leg begins when the pending motion will reach the arc's end.
void RotateThenDrive::next_phase_passing(const Pose2& pose) {
  const double turned_rad = on_corner(*corner_, pose.position_m).turned_rad + pending_m_ / corner_->radius_m;
  if (turned_rad < std::abs(corner_->turn_rad)) return;
  next_leg();
  phase_ = DrivePhase::driving;
  corner_ = corner_ahead();
}

void RotateThenDrive::next_leg() {
  leg_start_m_ = target_m();
  ++target_;
}

std::optional<Corner> RotateThenDrive::corner_ahead() const {
  if (on_last_leg()) return std::nullopt;
  return corner_at(leg_start_m_, target_m(), path_.waypoints_m[target_ + 1], options_);
}

void RotateThenDrive::begin_turn() {
  phase_ = DrivePhase::rotating;
  turn_heading_rad_.reset();
}

/// Ends the leg at its end. At the goal the distance counts too, Eq. (19): beyond epsilon the robot turns to
/// the goal again, up to most_approaches.
void RotateThenDrive::end_leg(const Pose2& pose) {
  begin_turn();
  leg_start_m_ = target_m();
  if (!on_last_leg()) {
    ++target_;
    return;
  }
  ++approaches_;
  const double distance_m = (target_m() - pose.position_m).norm();
  if (distance_m > options_.arrival_distance_m && approaches_ < most_approaches) {
    leg_start_m_ = pose.position_m;
    return;
  }
  phase_ = final_heading_rad_ ? DrivePhase::final_rotation : DrivePhase::arrived;
}

void RotateThenDrive::next_phase_final(const Pose2& pose) {
  const double error = wrap_angle(*final_heading_rad_ - pose.yaw_rad);
  if (at_rest() && std::abs(error) <= options_.arrival_heading_rad) phase_ = DrivePhase::arrived;
}

/// Turns on the spot, once the robot has stopped. Subtracts the pending rotation from the error, so that lag
/// causes no overshoot.
BodyVelocity RotateThenDrive::turn_to(double heading_rad, double done_rad, const Pose2& pose,
                                      const SpeedLimit& limit) const {
  if (std::abs(last_.forward_mps) > 0.5 * options_.min_forward_mps) return {};
  const double error = wrap_angle(heading_rad - pose.yaw_rad);
  const double left = wrap_angle(error - pending_rad_);
  if (std::abs(left) <= 0.5 * done_rad) return {};
  const double speed = approach_speed(
      std::abs(left), braking_share * options_.max_turn_acceleration_radps2, options_.min_turn_radps,
      std::clamp(limit.turn_radps, options_.min_turn_radps, options_.max_turn_radps));
  return {0.0, std::copysign(speed, left)};
}

/// Drives along the leg: steers against the cross-track error, and limits the speed so that the robot can
/// brake to rest, or to the corner's speed, by the leg's end. It brakes for the end itself, while the leg is
/// over a quarter of epsilon before: were both the same, half of all legs would end a trace short of that and
/// creep, or wait until the estimate moves there.
BodyVelocity RotateThenDrive::drive_leg(const Pose2& pose, const SpeedLimit& limit) const {
  const double left_m = remaining_m(pose) - pending_m_ - (corner_ ? corner_->cut_m : 0.0);
  const double end_mps = corner_ ? corner_->speed_mps : 0.0;
  if (!corner_ && left_m <= 0.0) return {};
  const double leg_heading = leg_heading_rad();
  const Vec2 ahead(std::cos(leg_heading), std::sin(leg_heading));
  const Vec2 from_target = pose.position_m - target_m();
  const double beside_m = cross(ahead, from_target);
  const double wanted_heading = leg_heading - std::atan(lateral_gain_per_m * beside_m);
  const double turn = steered(wanted_heading, pose);
  if (limit.forward_mps < options_.min_forward_mps) return {0.0, turn};
  const double error = wrap_angle(wanted_heading - pose.yaw_rad - pending_rad_);
  const double deceleration = braking_share * options_.max_acceleration_mps2;
  const double speed =
      approach_speed(left_m + 0.5 * end_mps * end_mps / deceleration, deceleration, options_.min_forward_mps,
                     std::min(options_.max_forward_mps, limit.forward_mps));
  return {std::max(options_.min_forward_mps, speed * std::cos(error)), turn};
}

/// Drives along the arc, with the heading of the point where the command takes effect.
BodyVelocity RotateThenDrive::pass_corner(const Pose2& pose, const SpeedLimit& limit) const {
  const double side = std::copysign(1.0, corner_->turn_rad);
  const OnCorner on = on_corner(*corner_, pose.position_m);
  const double turned_rad =
      std::clamp(on.turned_rad + pending_m_ / corner_->radius_m, 0.0, std::abs(corner_->turn_rad));
  const double wanted_heading =
      corner_->heading_rad + side * turned_rad - std::atan(lateral_gain_per_m * on.beside_m);
  const double speed =
      limit.forward_mps < options_.min_forward_mps ? 0.0 : std::min(corner_->speed_mps, limit.forward_mps);
  const double along_radps = side * speed / corner_->radius_m;
  return {speed, std::clamp(along_radps + steered(wanted_heading, pose), -options_.max_turn_radps,
                            options_.max_turn_radps)};
}

/// Turn rate that corrects the heading while driving.
double RotateThenDrive::steered(double wanted_heading_rad, const Pose2& pose) const {
  const double error = wrap_angle(wanted_heading_rad - pose.yaw_rad - pending_rad_);
  return std::clamp(heading_gain_per_s * error, -options_.max_turn_radps, options_.max_turn_radps);
}

BodyVelocity RotateThenDrive::command(const BodyVelocity& wanted, Duration elapsed) {
  const double elapsed_s = bounded_s(elapsed);
  const BodyVelocity reachable = within_wheel_limit(wanted, options_.track_width_m, options_.max_wheel_mps);
  last_ = {
      stepped(last_.forward_mps, reachable.forward_mps, options_.max_acceleration_mps2 * elapsed_s),
      stepped(last_.turn_radps, reachable.turn_radps, options_.max_turn_acceleration_radps2 * elapsed_s)};
  pending_m_ = pending_after(pending_m_, last_.forward_mps, options_.response_s, elapsed_s);
  pending_rad_ = pending_after(pending_rad_, last_.turn_radps, options_.response_s, elapsed_s);
  return last_;
}

bool RotateThenDrive::at_rest() const {
  const double trace_m = 0.2 * options_.arrival_distance_m;
  const double trace_rad = 0.4 * turn_done_rad;
  return !asks_for_motion(last_) && std::abs(pending_m_) <= trace_m && std::abs(pending_rad_) <= trace_rad;
}

Path RotateThenDrive::path_ahead() const {
  if (path_.waypoints_m.empty()) return {};
  Path ahead{{leg_start_m_}};
  ahead.waypoints_m.insert(ahead.waypoints_m.end(),
                           path_.waypoints_m.begin() + static_cast<std::ptrdiff_t>(target_),
                           path_.waypoints_m.end());
  return ahead;
}

double RotateThenDrive::epsilon_m() const {
  return on_last_leg() ? options_.arrival_distance_m : waypoint_distance_m;
}

/// Distance left along the leg; negative past its end.
double RotateThenDrive::remaining_m(const Pose2& pose) const {
  const double heading = leg_heading_rad();
  return (target_m() - pose.position_m).dot(Vec2(std::cos(heading), std::sin(heading)));
}

double RotateThenDrive::leg_heading_rad() const {
  return heading_between(leg_start_m_, target_m());
}

}  // namespace lodestar
