#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/viewers/channel.hpp"
#include "maps/camera_model.hpp"
#include "maps/marker_registry.hpp"
#include "maps/motion.hpp"
#include "maps/occupancy_map.hpp"

// Messages by Foxglove's schemas. Frames: map, base_link, camera, in our conventions (docs/frames.md).
namespace lodestar {

using MessageJson = nlohmann::ordered_json;

MessageJson time_json(Stamp stamp);
/// Seven numbers, rounded to a micrometre and to 1e-9 of a quaternion.
MessageJson pose_json(const Eigen::Isometry3d& pose);

MessageJson transform_message(Stamp stamp, const char* parent, const char* child,
                              const Eigen::Isometry3d& parent_from_child);
MessageJson pose_message(Stamp stamp, const Eigen::Isometry3d& map_from_base);
MessageJson path_message(Stamp stamp, const Path& path);
MessageJson grid_message(Stamp stamp, const OccupancyMap& map);
/// A plate and its ID for each marker, replacing all previous ones; `distrusted` ones in red.
MessageJson markers_message(Stamp stamp, const MarkerRegistry& registry, const std::vector<int>& distrusted);
/// The robot's shape on the floor: a disc, or an outline where it has one.
struct RobotBody {
  double radius_m = 0.0;
  std::vector<Vec2> outline_m;  ///< corners in the robot frame
};

/// The footprint, and the ellipse of three standard deviations about the estimated position.
MessageJson robot_message(const PoseEstimate& estimate, const RobotBody& robot);
MessageJson calibration_message(Stamp stamp, const CameraModel& camera);
MessageJson picture_message(Stamp stamp, const std::string& jpeg);

enum class LogLevel { info = 2, warning = 3, error = 4 };
MessageJson log_message(Stamp stamp, LogLevel level, const std::string& words);

}  // namespace lodestar
