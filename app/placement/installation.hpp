#pragma once

#include <optional>
#include <string>
#include <vector>

#include "maps/marker_registry.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

/// To the faces of the walls nearest to a marker's centre, along the grid's axes. Nothing where no wall lies
/// in that direction.
struct WallDistances {
  std::optional<double> left_m;   ///< towards -x of the grid
  std::optional<double> right_m;  ///< towards +x
  std::optional<double> below_m;  ///< towards -y
  std::optional<double> above_m;  ///< towards +y
};

/// The nearer of two opposite walls, in the caller's words, and how far it is; nothing where there is
/// neither.
struct NearerWall {
  std::string side;
  double distance_m = 0.0;
};
std::optional<NearerWall> nearer_wall(const std::string& low, const std::optional<double>& low_m,
                                      const std::string& high, const std::optional<double>& high_m);

WallDistances wall_distances(const OccupancyMap& map, const Vec2& center_in_map_m);

/// What whoever hangs the markers needs, as CSV: `id,x_m,y_m,z_m,yaw_deg,wall_x,wall_x_m,wall_y,wall_y_m,
/// face,site,date`. x, y are of the square's centre and yaw of the arrow O to X, on the map. Of each pair of
/// opposite walls the nearer one is named (left or right, below or above on the map) with the distance to its
/// face; both are empty where there is none.
std::string installation_csv(const MarkerRegistry& registry, const OccupancyMap& map, const std::string& site,
                             const std::string& date);

}  // namespace lodestar
