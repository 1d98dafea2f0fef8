#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/navigation/mission.hpp"
#include "drivers/base/base_driver.hpp"
#include "maps/motion.hpp"
#include "maps/scan.hpp"

// What passes between the control loop and the thread that speaks to ROS 2.
namespace lodestar {

/// The robot at one step.
struct Ros2Report {
  Stamp now;
  std::optional<PoseEstimate> estimate;
  std::optional<Pose2>
      odom_from_base;                ///< by the wheels, at the estimate's time; else at the newest reading's
  Stamp odometry_stamp;              ///< that time
  BodyVelocity velocity;             ///< by the wheels
  std::vector<Scan> scans;           ///< since the report before
  std::shared_ptr<const Path> path;  ///< being driven; null for none
  std::optional<StopReason> stop;
  std::optional<StopReason> slowed_by;
  BaseState base = BaseState::waiting_for_base;
  std::optional<BaseFault> fault;
  std::string fault_details;
  std::optional<double> battery_v;
  std::vector<int> markers;  ///< of the newest fix
  std::vector<int> distrusted;
};

/// Topic initialpose: a person says where the robot is.
struct Ros2Place {
  Pose2 map_from_base;
  PlacingSigma sigma;
};

/// Topic goal_pose.
struct Ros2Goal {
  Pose2 map_from_base;
};

/// Topic odom, where another program drives the robot.
struct OdometryReading {
  Stamp stamp;
  Pose2 odom_from_base;
};

using Ros2Command = std::variant<Ros2Place, Ros2Goal>;

}  // namespace lodestar
