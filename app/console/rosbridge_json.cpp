#include "app/console/rosbridge_json.hpp"

#include <array>
#include <cmath>

#include "app/ros2/ros2_commands.hpp"
#include "app/ros2/ros2_shapes.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

ordered_json time_json(Duration time) {
  const auto whole = std::chrono::floor<std::chrono::seconds>(time);
  return {{"sec", whole.count()}, {"nanosec", (time - whole).count()}};
}

ordered_json header_json(Duration unix_time) {
  return {{"stamp", time_json(unix_time)}, {"frame_id", "map"}};
}

ordered_json ros_pose_json(const Pose2& pose) {
  const double half_rad = 0.5 * pose.yaw_rad;
  return {{"position", {{"x", pose.position_m.x()}, {"y", pose.position_m.y()}, {"z", 0.0}}},
          {"orientation", {{"x", 0.0}, {"y", 0.0}, {"z", std::sin(half_rad)}, {"w", std::cos(half_rad)}}}};
}

double number(const json& object, const char* name) {
  return object.value(name, 0.0);
}

/// `message`: with a header; `pose`: the geometry_msgs/Pose in it.
Pose2 pose_from(const json& message, const json& pose) {
  try {
    const json& position = pose.at("position");
    const json& turn = pose.at("orientation");
    const auto found = planar_pose(
        {.frame = message.at("header").at("frame_id").get<std::string>(),
         .position_m = {number(position, "x"), number(position, "y"), number(position, "z")},
         .quaternion = {number(turn, "x"), number(turn, "y"), number(turn, "z"), turn.value("w", 1.0)}});
    if (const auto* why = std::get_if<std::string>(&found)) throw InputError(*why);
    return std::get<Pose2>(found);
  } catch (const json::exception&) {
    throw InputError("found another message, wanted a header with frame_id, a position and an orientation");
  }
}

}  // namespace

ordered_json pose_stamped_json(Duration unix_time, const Pose2& map_from_base) {
  return {{"header", header_json(unix_time)}, {"pose", ros_pose_json(map_from_base)}};
}

ordered_json estimate_json(Duration unix_time, const PoseEstimate& estimate) {
  constexpr std::array<std::size_t, 3> places{0, 1, 5};  // x, y, yaw among x, y, z, roll, pitch, yaw
  std::array<double, 36> covariance{};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      covariance.at(6 * places.at(row) + places.at(column)) =
          estimate.covariance(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
  return {{"header", header_json(unix_time)},
          {"pose", {{"pose", ros_pose_json(estimate.map_from_base)}, {"covariance", covariance}}}};
}

ordered_json plan_json(Duration unix_time, const Path& path) {
  ordered_json poses = ordered_json::array();
  double yaw_rad = 0.0;
  for (std::size_t i = 0; i < path.waypoints_m.size(); ++i) {
    if (i + 1 < path.waypoints_m.size())
      yaw_rad = heading_between(path.waypoints_m[i], path.waypoints_m[i + 1]);
    poses.push_back(pose_stamped_json(unix_time, {path.waypoints_m[i], yaw_rad}));
  }
  return {{"header", header_json(unix_time)}, {"poses", poses}};
}

ordered_json grid_json(Duration unix_time, const OccupancyMap& map) {
  const OccupancyMap aligned = axis_aligned(map);
  return {{"header", header_json(unix_time)},
          {"info",
           {{"map_load_time", time_json(unix_time)},
            {"resolution", aligned.resolution_m},
            {"width", aligned.columns},
            {"height", aligned.rows},
            {"origin", ros_pose_json(aligned.map_from_grid)}}},
          {"data", aligned.cells}};
}

ordered_json feedback_json(Duration unix_time, const PoseEstimate& estimate, Duration driven, double left_m) {
  return {{"current_pose", pose_stamped_json(unix_time, estimate.map_from_base)},
          {"navigation_time", time_json(driven)},
          {"estimated_time_remaining", time_json(Duration{})},
          {"number_of_recoveries", 0},
          {"distance_remaining", left_m}};
}

Goal goal_from_pose_stamped(const json& message) {
  if (!message.contains("pose")) throw InputError("found no pose, wanted a geometry_msgs/PoseStamped");
  const Pose2 pose = pose_from(message, message.at("pose"));
  return {.position_m = pose.position_m, .heading_rad = pose.yaw_rad};
}

Pose2 pose_from_initial(const json& message) {
  if (!message.contains("pose") || !message.at("pose").is_object() || !message.at("pose").contains("pose"))
    throw InputError("found no pose, wanted a geometry_msgs/PoseWithCovarianceStamped");
  return pose_from(message, message.at("pose").at("pose"));
}

}  // namespace lodestar
