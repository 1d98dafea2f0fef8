#pragma once

#include <optional>

#include "maps/occupancy_map.hpp"

namespace lodestar {

/// Where a ray in the plane of the map first meets something.
struct RayHit {
  double range_m = 0.0;  ///< 0 when the ray begins inside of it
  /// Cosine of the angle between the ray and the normal of what it meets: 1 head-on, 0 grazing.
  double incidence_cos = 1.0;
};

/// The first occupied cell (value >= 50) along a ray, by exact grid traversal (Amanatides and Woo, "A fast
/// voxel traversal algorithm for ray tracing", 1987). Unknown cells and the outside of the map are
/// transparent. Nothing when there is none up to `max_range_m`, or when a number is not finite.
std::optional<RayHit> cast_ray(const OccupancyMap& map, const Vec2& from_in_map, double heading_in_map_rad,
                               double max_range_m);

/// The range of that cell alone.
std::optional<double> range_to_obstacle_m(const OccupancyMap& map, const Vec2& from_in_map,
                                          double heading_in_map_rad, double max_range_m);

/// A disc in the way of a ray with this direction, which has length 1.
std::optional<RayHit> cast_ray_at_disc(const Vec2& from, const Vec2& direction, const Vec2& center,
                                       double radius_m);

/// Whether no occupied cell lies between two points.
bool is_in_sight(const OccupancyMap& map, const Vec2& from_in_map, const Vec2& to_in_map);

}  // namespace lodestar
