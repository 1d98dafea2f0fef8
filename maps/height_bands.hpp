#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "maps/occupancy_map.hpp"

namespace lodestar {

/// The occupied height bands of an OctoMap above each cell of a floor map, compact enough for a web page to
/// trace sight lines through it while a marker is dragged.
struct HeightBands {
  static constexpr int count = 32;

  double low_m = 0.0;    ///< of the lowest band, in the map frame
  double step_m = 0.0;   ///< of one band; not less than a voxel
  double touch_m = 0.0;  ///< voxels nearer than this to an end of a sight line do not block it
  /// In the map's order; bit k: occupied in the band that begins at low_m + k step_m.
  std::vector<std::uint32_t> cells;
};

/// The bands from low_m to high_m. Throws InputError.
HeightBands height_bands(const std::filesystem::path& octomap_file, const OccupancyMap& map, double low_m,
                         double high_m);

}  // namespace lodestar
