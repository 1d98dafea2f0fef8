#pragma once

#include <dds/dds.h>

#include "app/ros2/dds_node.hpp"

// The topics, with the types and the QoS that ROS 2's own nodes give them (REP 2003, tf2_ros, Nav2), and the
// types' hashes (REP 2016).
namespace lodestar::ros_topics {

extern const RosTopic tf;
extern const RosTopic tf_static;
extern const RosTopic odom;
extern const RosTopic amcl_pose;
extern const RosTopic map;
extern const RosTopic plan;
extern const RosTopic scan;
extern const RosTopic diagnostics;
extern const RosTopic battery_state;
extern const RosTopic clock;
extern const RosTopic initialpose;
extern const RosTopic goal_pose;

}  // namespace lodestar::ros_topics
