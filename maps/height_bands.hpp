#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "maps/occupancy_map.hpp"

namespace lodestar {

/// What an OctoMap shows to be occupied above each cell of a floor map, in so few bytes that a page can
/// follow sight lines through it while a marker is dragged.
struct HeightBands {
  static constexpr int count = 32;

  double low_m = 0.0;    ///< of the lowest band, in the map frame
  double step_m = 0.0;   ///< of one band; not less than a voxel
  double touch_m = 0.0;  ///< what is nearer than this to an end of a sight line touches it and hides nothing
  std::vector<std::uint32_t>
      cells;  ///< as the map's; bit k: something from low_m + k step_m on, in that band
};

/// Of the heights from low_m to high_m. Throws InputError.
HeightBands height_bands(const std::filesystem::path& octomap_file, const OccupancyMap& map, double low_m,
                         double high_m);

}  // namespace lodestar
