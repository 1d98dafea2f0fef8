#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/live/robot_state.hpp"
#include "app/site/goal.hpp"
#include "maps/occupancy_map.hpp"

// ROS 2's messages as rosbridge writes them: JSON with the fields of the .msg files.
namespace lodestar {

/// geometry_msgs/PoseStamped in the map frame. `unix_time`: since 1970.
nlohmann::ordered_json pose_stamped_json(Duration unix_time, const Pose2& map_from_base);
/// geometry_msgs/PoseWithCovarianceStamped.
nlohmann::ordered_json estimate_json(Duration unix_time, const PoseEstimate& estimate);
/// nav_msgs/Path; a pose at each waypoint, along the leg that begins there.
nlohmann::ordered_json plan_json(Duration unix_time, const Path& path);
/// nav_msgs/OccupancyGrid, along the axes of the map frame.
nlohmann::ordered_json grid_json(Duration unix_time, const OccupancyMap& map);
/// The feedback of nav2_msgs/NavigateToPose.
nlohmann::ordered_json feedback_json(Duration unix_time, const PoseEstimate& estimate, Duration driven,
                                     double left_m);

/// Reads a geometry_msgs/PoseStamped as a goal; what may be left out has ROS's defaults. Throws InputError
/// for what is no pose of the map (planar_pose()).
Goal goal_from_pose_stamped(const nlohmann::json& message);
/// The pose of a geometry_msgs/PoseWithCovarianceStamped, likewise.
Pose2 pose_from_initial(const nlohmann::json& message);

}  // namespace lodestar
