#pragma once

#include <nlohmann/json.hpp>

#include "maps/occupancy_map.hpp"

namespace lodestar {

/// {"x_m", "y_m", "yaw_deg"}.
nlohmann::ordered_json pose_json(const Pose2& pose);

/// A map without its cells: {"columns", "rows", "resolution_m", "origin"}.
nlohmann::ordered_json map_json(const OccupancyMap& map);

}  // namespace lodestar
