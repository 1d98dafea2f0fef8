#include "app/ros2/ros2_session.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "app/recording/drive_moment.hpp"

namespace lodestar {

Ros2Session::Ros2Session(Ros2Link& link, const Ros2Options& options, double track_width_m,
                         std::function<void(const std::string&)> tell)
    : link_(link),
      options_(options),
      track_width_m_(track_width_m),
      tell_(std::move(tell)),
      track_({.track_width_m = track_width_m}) {}

void Ros2Session::say(const std::string& words) const {
  if (tell_) tell_("ros2: " + words);
}

void Ros2Session::attend(const SensorInput& input, const MissionStep& step, Mission& mission) {
  remember(input, step, mission);
  if (const std::string words = in_words(mission, step.event); is_ours_ && !words.empty()) say(words);
  if (mission.finished()) is_ours_ = false;
  for (const Ros2Command& command : link_.take_commands())
    std::visit([&](const auto& wanted) { take(wanted, mission); }, command);
  drive(mission);
  link_.publish(report_of(input, step));
}

void Ros2Session::take(const Ros2Place& place, Mission& mission) const {
  const Pose2& pose = place.map_from_base;
  const bool done = mission.finished() && mission.place_robot(pose, place.sigma);
  say(fmt::format("initialpose ({:.2f}, {:.2f}, {:.0f} deg){}", pose.position_m.x(), pose.position_m.y(),
                  degrees(pose.yaw_rad), done ? "" : ": not now, the robot drives or moves"));
}

void Ros2Session::take(const Ros2Goal& goal, Mission& mission) {
  const Pose2& pose = goal.map_from_base;
  const bool is_free = mission.finished() && mission.phase() != MissionPhase::by_hand;
  say(fmt::format("goal_pose ({:.2f}, {:.2f}, {:.0f} deg){}", pose.position_m.x(), pose.position_m.y(),
                  degrees(pose.yaw_rad),
                  is_free || is_ours_ ? "" : ": refused, the robot is driven by another"));
  if (!is_free && !is_ours_) return;
  if (is_ours_) mission.stop();
  next_ = Goal{.position_m = pose.position_m, .heading_rad = pose.yaw_rad};
}

void Ros2Session::drive(Mission& mission) {
  if (!next_ || !mission.finished()) return;
  mission.start({*next_});
  next_.reset();
  is_ours_ = true;
}

void Ros2Session::remember(const SensorInput& input, const MissionStep& step, const Mission& mission) {
  for (const WheelTravel& reading : input.base.travel) {
    track_.add(reading);
    newest_ = reading;
  }
  if (input.base.system && input.base.system->battery_v > 0.0) battery_v_ = input.base.system->battery_v;
  if (!step.navigation.fixes.empty()) markers_ = step.navigation.fixes.back().fix.ids;
  if (mission.finished()) {
    path_.reset();
  } else if (!path_ || path_->waypoints_m != mission.path().waypoints_m) {
    path_ = std::make_shared<const Path>(mission.path());
  }
}

/// Where another program has the odometry, the pose must be the one that it said.
std::optional<Pose2> Ros2Session::odometry_at(Stamp stamp) const {
  if (!options_.reads_odometry) return track_.pose_at(stamp);
  const auto before = std::ranges::find_if(readings_.rbegin(), readings_.rend(),
                                           [&](const OdometryReading& said) { return said.stamp <= stamp; });
  if (before == readings_.rend()) return std::nullopt;
  return before->odom_from_base;
}

std::vector<WheelTravel> Ros2Session::wheel_travel() {
  constexpr std::size_t most_kept = 256;  // some seconds
  std::vector<WheelTravel> travel;
  for (const OdometryReading& reading : link_.take_odometry()) {
    if (!readings_.empty() && reading.stamp <= readings_.back().stamp) continue;
    if (!readings_.empty()) {
      const Pose2 rolled = inverse(readings_.back().odom_from_base) * reading.odom_from_base;
      const double half_rad = 0.5 * rolled.yaw_rad;
      const double stretch = std::abs(half_rad) < 1e-6 ? 1.0 : half_rad / std::sin(half_rad);
      const double arc_m = stretch * std::copysign(rolled.position_m.norm(), rolled.position_m.x());
      rolled_.left_m += arc_m - half_rad * track_width_m_;
      rolled_.right_m += arc_m + half_rad * track_width_m_;
    }
    rolled_.stamp = reading.stamp;
    travel.push_back(rolled_);
    readings_.push_back(reading);
    if (readings_.size() > most_kept) readings_.pop_front();
  }
  return travel;
}

Ros2Report Ros2Session::report_of(const SensorInput& input, const MissionStep& step) const {
  const NavigationStep& navigation = step.navigation;
  Ros2Report report{.now = input.now,
                    .estimate = navigation.estimate,
                    .odometry_stamp = newest_ ? newest_->stamp : input.now,
                    .velocity = track_.velocity(),
                    .scans = input.scans,
                    .path = path_,
                    .stop = navigation.stop,
                    .slowed_by = navigation.slowed_by,
                    .base = input.base.state,
                    .fault = input.base.fault,
                    .fault_details = input.base.details,
                    .battery_v = battery_v_,
                    .markers = markers_};
  if (navigation.estimate) report.odometry_stamp = navigation.estimate->stamp;
  report.odom_from_base = odometry_at(report.odometry_stamp);
  for (const DistrustedMarker& marker : navigation.distrusted) report.distrusted.push_back(marker.id);
  return report;
}

}  // namespace lodestar
