#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

#include "maps/occupancy_map.hpp"

namespace octomap {
class OcTree;
}

namespace lodestar {

struct OctomapInfo {
  double resolution_m = 0.0;
  std::size_t leaves_occupied = 0;
  std::size_t leaves_free = 0;
  Vec3 low_m = Vec3::Zero();   ///< corner of the known space
  Vec3 high_m = Vec3::Zero();  ///< opposite corner
};

/// The content of an OctoMap .bt or .ot file, read once.
class Octomap {
 public:
  /// Throws InputError.
  explicit Octomap(const std::filesystem::path& file);

  [[nodiscard]] OctomapInfo info() const;

  /// Height of the floor: the top of the layer with the most voxels that have free space above them, or,
  /// where sensor noise spreads the floor over several layers, of the highest adjacent layer with at least a
  /// fifth of that number. Empty when no voxel has free space above it. A slice that begins below this height
  /// reads the floor as an obstacle.
  [[nodiscard]] std::optional<double> floor_m() const;

  /// The slab z_min_m <= z < z_max_m as a floor map: a cell is occupied when any voxel of its column that
  /// reaches into the slab is, free when at least one voxel is known free and none occupied, unknown
  /// otherwise. Throws InputError for a slab that is empty or inverted.
  [[nodiscard]] OccupancyMap slice(double z_min_m, double z_max_m) const;

 private:
  std::filesystem::path file_;
  std::shared_ptr<const octomap::OcTree> tree_;
};

}  // namespace lodestar
