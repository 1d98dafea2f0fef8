#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "maps/occupancy_map.hpp"

namespace lodestar {

/// What a new site is made of, besides its map.
struct NewSite {
  OccupancyMap map;
  std::filesystem::path robot_file;   ///< robot.yaml to begin with
  std::filesystem::path camera_file;  ///< camera.yaml to begin with
  std::string camera_profile;         ///< its name in site.yaml
  std::string base_protocol;          ///< "agilex" or "odrive"
  // Of the robot; nothing: as the file has them.
  std::optional<double> radius_m;
  std::optional<double> camera_height_m;  ///< above the floor
};

/// Where a new site's usual drive begins and ends: the place with the most room, and of those that the robot
/// reaches from there with `room_m` around its centre the farthest. In the map frame.
struct StartAndGoal {
  Vec2 start_m = Vec2::Zero();
  Vec2 goal_m = Vec2::Zero();
};

/// Throws InputError when no place has that much room.
StartAndGoal start_and_goal(const OccupancyMap& map, double room_m);

/// Makes a complete site folder: site.yaml, map.yaml with its image, an empty markers.yaml, camera.yaml,
/// robot.yaml and an empty places.yaml. The folder appears whole or not at all, after it has been read back.
/// Throws InputError when there is something of that name, or when it cannot be written.
void make_site(const NewSite& site, const std::filesystem::path& folder);

}  // namespace lodestar
