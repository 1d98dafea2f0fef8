#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/navigation/mission.hpp"
#include "app/ros2/ros2_link.hpp"
#include "app/ros2/ros2_options.hpp"
#include "localization/scan/wheel_track.hpp"

namespace lodestar {

/// ROS 2 as seen by the control loop: reports each step, and carries out what initialpose and goal_pose ask
/// for. A goal is driven to when nobody else drives: it replaces one that came the same way, and is refused
/// while the console, a fleet's master or the command line has the robot.
class Ros2Session {
 public:
  /// `track_width_m`: of the wheels. `tell` receives each event, in words, for a log.
  Ros2Session(Ros2Link& link, const Ros2Options& options, double track_width_m,
              std::function<void(const std::string&)> tell = {});

  /// What the odometry of topic odom comes to for wheels on this track, since the last call: arcs of which
  /// the wheels roll their ends' shares.
  [[nodiscard]] std::vector<WheelTravel> wheel_travel();
  /// Call after each step.
  void attend(const SensorInput& input, const MissionStep& step, Mission& mission);

 private:
  void take(const Ros2Place& place, Mission& mission) const;
  void take(const Ros2Goal& goal, Mission& mission);
  void drive(Mission& mission);
  void remember(const SensorInput& input, const MissionStep& step, const Mission& mission);
  [[nodiscard]] std::optional<Pose2> odometry_at(Stamp stamp) const;
  [[nodiscard]] Ros2Report report_of(const SensorInput& input, const MissionStep& step) const;
  void say(const std::string& words) const;

  Ros2Link& link_;
  Ros2Options options_;
  double track_width_m_;
  std::function<void(const std::string&)> tell_;
  WheelTrack track_;
  std::deque<OdometryReading> readings_;  ///< of topic odom, the latest
  WheelTravel rolled_;                    ///< what they come to
  std::optional<WheelTravel> newest_;
  bool is_ours_ = false;      ///< the present drive came by goal_pose
  std::optional<Goal> next_;  ///< to drive to once the robot has come to rest
  std::shared_ptr<const Path> path_;
  std::optional<double> battery_v_;
  std::vector<int> markers_;
};

}  // namespace lodestar
