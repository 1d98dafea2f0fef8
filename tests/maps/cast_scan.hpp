#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "maps/grid_walk.hpp"
#include "maps/occupancy_map.hpp"
#include "maps/random.hpp"
#include "maps/scan.hpp"

// Scans of a map, for tests that know where the scanner is.
namespace lodestar::testing {

/// To the first cell that is occupied; nothing where there is none within reach.
inline std::optional<double> range_in_map_m(const OccupancyMap& map, const Vec2& from_in_map,
                                            double heading_rad, double max_range_m) {
  const Pose2 grid_from_map = inverse(map.map_from_grid);
  const Vec2 to_in_map = from_in_map + max_range_m * Vec2(std::cos(heading_rad), std::sin(heading_rad));
  std::optional<double> range_m;
  walk_grid((grid_from_map * from_in_map) / map.resolution_m, (grid_from_map * to_in_map) / map.resolution_m,
            [&](Cell cell, double enters, double) {
              if (!map.contains(cell)) return true;
              if (map.at(cell) != OccupancyMap::occupied) return true;
              range_m = enters * max_range_m;
              return false;
            });
  return range_m;
}

/// Something that the map does not have, such as a leg.
struct Disc {
  Vec2 center_in_map = Vec2::Zero();
  double radius_m = 0.2;
};

inline std::optional<double> range_to_disc_m(const Disc& disc, const Vec2& from_in_map, double heading_rad) {
  const Vec2 way(std::cos(heading_rad), std::sin(heading_rad));
  const Vec2 to_center = disc.center_in_map - from_in_map;
  const double along = to_center.dot(way);
  const double aside = cross(way, to_center);
  if (along <= 0.0 || std::abs(aside) >= disc.radius_m) return std::nullopt;
  return along - std::sqrt(square(disc.radius_m) - square(aside));
}

struct CastOptions {
  int beams = 360;
  double min_range_m = 0.05;
  double max_range_m = 12.0;
  double noise_m = 0.01;
  Duration turn = std::chrono::milliseconds(100);
};

/// One turn that begins at `begin`; `map_from_scanner` says where the scanner is at a time.
inline Scan cast_scan(const OccupancyMap& map, const std::vector<Disc>& discs, Stamp begin,
                      const std::function<Pose2(Stamp)>& map_from_scanner, Random& random,
                      const CastOptions& options = {}) {
  Scan scan{.min_range_m = options.min_range_m, .max_range_m = options.max_range_m};
  for (int i = 0; i < options.beams; ++i) {
    Beam beam{.stamp = begin + i * options.turn / options.beams,
              .angle_rad = wrap_angle(-std::numbers::pi + 2.0 * std::numbers::pi * (i + 0.5) / options.beams),
              .echo = Echo::nothing};
    const Pose2 pose = map_from_scanner(beam.stamp);
    const double heading_rad = pose.yaw_rad + beam.angle_rad;
    std::optional<double> range_m = range_in_map_m(map, pose.position_m, heading_rad, options.max_range_m);
    for (const Disc& disc : discs)
      if (const auto to_disc = range_to_disc_m(disc, pose.position_m, heading_rad))
        range_m = std::min(range_m.value_or(*to_disc), *to_disc);
    if (range_m && *range_m < options.min_range_m) beam.echo = Echo::too_near;
    if (range_m && *range_m >= options.min_range_m && *range_m <= options.max_range_m) {
      beam.echo = Echo::hit;
      beam.range_m = std::max(options.min_range_m, *range_m + options.noise_m * random.normal());
      beam.intensity = 0.5F;
    }
    scan.beams.push_back(beam);
  }
  return scan;
}

/// The same pose for each beam.
inline std::vector<Pose2> poses_of(const Scan& scan, const Pose2& map_from_scanner) {
  return std::vector<Pose2>(scan.beams.size(), map_from_scanner);
}

/// A room of free floor between walls of one cell, with its lower left corner at the origin.
inline OccupancyMap walled_room(double width_m, double depth_m, double resolution_m = 0.05) {
  OccupancyMap map{.columns = static_cast<int>(std::lround(width_m / resolution_m)),
                   .rows = static_cast<int>(std::lround(depth_m / resolution_m)),
                   .resolution_m = resolution_m};
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column)
      map.cells.push_back(row == 0 || column == 0 || row == map.rows - 1 || column == map.columns - 1
                              ? OccupancyMap::occupied
                              : OccupancyMap::free);
  return map;
}

/// Occupies a rectangle of a map.
inline void put_box(OccupancyMap& map, const Vec2& low_m, const Vec2& high_m) {
  const Cell first = map.cell_at(low_m);
  const Cell last = map.cell_at(high_m);
  for (int row = first.row; row <= last.row; ++row)
    for (int column = first.column; column <= last.column; ++column)
      if (map.contains({column, row})) map.cells[map.index({column, row})] = OccupancyMap::occupied;
}

}  // namespace lodestar::testing
