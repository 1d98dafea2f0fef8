#pragma once

#include <string>

namespace lodestar {

/// ROS 2 distributions, by what differs on the wire.
enum class RosDistro { humble, jazzy };

struct Ros2Options {
  int domain = 0;         ///< ROS_DOMAIN_ID
  std::string interface;  ///< network interface; empty: the one that the system prefers
  RosDistro distro = RosDistro::jazzy;
  bool takes_commands = false;     ///< of topics initialpose and goal_pose
  bool is_simulated = false;       ///< stamps are simulated time, which /clock tells
  bool publishes_odometry = true;  ///< odom, and odom -> base_link; false where another program does
  bool reads_odometry = false;     ///< of topic odom, to follow the pose with
};

}  // namespace lodestar
