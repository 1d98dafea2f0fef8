#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "maps/occupancy_map.hpp"

namespace lodestar {

struct OctomapInfo {
  double resolution_m = 0.0;
  std::size_t leaves_occupied = 0;
  std::size_t leaves_free = 0;
  Vec3 low_m = Vec3::Zero();   ///< corner of the known space
  Vec3 high_m = Vec3::Zero();  ///< opposite corner
};

/// Reads what an OctoMap .bt or .ot file holds. Throws InputError.
OctomapInfo octomap_info(const std::filesystem::path& file);

/// Height of the floor: the top of the layer that has more voxels with free air upon them than any other, or,
/// where measured noise has spread it over several, of the highest adjacent one with a fifth of them. Nothing
/// where no voxel has free air upon it. A slice that begins below takes the floor for an obstacle. Throws
/// InputError.
std::optional<double> octomap_floor_m(const std::filesystem::path& file);

/// The slab z_min_m <= z < z_max_m of an OctoMap as a floor map: a cell is occupied when any voxel of its
/// column that reaches into the slab is, free when at least one voxel is known free and none occupied,
/// unknown otherwise. Throws InputError for an unreadable file or a slab that is empty or inverted.
OccupancyMap octomap_slice(const std::filesystem::path& file, double z_min_m, double z_max_m);

}  // namespace lodestar
