#include "maps/height_bands.hpp"

#include <algorithm>
#include <cmath>

#include "maps/octree_file.hpp"

namespace lodestar {
namespace {

/// The bits of all bands that overlap the heights from `from_m` to `to_m`.
std::uint32_t bits_between(const HeightBands& bands, double from_m, double to_m) {
  constexpr double tolerance_m = 1e-6;  // a voxel's face on the boundary of two bands belongs to one of them
  const auto first = static_cast<int>(std::floor((from_m - bands.low_m + tolerance_m) / bands.step_m));
  const auto last = static_cast<int>(std::floor((to_m - bands.low_m - tolerance_m) / bands.step_m));
  std::uint32_t bits = 0;
  for (int band = std::max(first, 0); band <= std::min(last, HeightBands::count - 1); ++band)
    bits |= 1U << static_cast<unsigned>(band);
  return bits;
}

/// Sets the bits in every cell that a voxel's square covers, sampled at half the cell size: the grid may be
/// rotated.
void add_voxel(HeightBands& bands, const OccupancyMap& map, const Vec3& middle, double side_m) {
  const std::uint32_t bits = bits_between(bands, middle.z() - 0.5 * side_m, middle.z() + 0.5 * side_m);
  if (bits == 0) return;
  const int looks = std::max(1, static_cast<int>(std::ceil(2.0 * side_m / map.resolution_m)));
  for (int i = 0; i < looks; ++i) {
    for (int k = 0; k < looks; ++k) {
      const Vec2 from_middle = side_m * (Vec2(i + 0.5, k + 0.5) / looks - Vec2(0.5, 0.5));
      const Cell cell = map.cell_at(middle.head<2>() + from_middle);
      if (map.contains(cell)) bands.cells[map.index(cell)] |= bits;
    }
  }
}

}  // namespace

HeightBands height_bands(const std::filesystem::path& octomap_file, const OccupancyMap& map, double low_m,
                         double high_m) {
  constexpr double touch_voxels = 1.8;  // the same as in SightLines
  const std::unique_ptr<octomap::OcTree> tree = read_octree(octomap_file);
  HeightBands bands{.low_m = low_m,
                    .step_m = std::max(tree->getResolution(), (high_m - low_m) / HeightBands::count),
                    .touch_m = touch_voxels * tree->getResolution(),
                    .cells = std::vector<std::uint32_t>(map.cells.size(), 0)};
  for (auto leaf = tree->begin_leafs(); leaf != tree->end_leafs(); ++leaf) {
    if (!tree->isNodeOccupied(*leaf)) continue;
    add_voxel(bands, map, {leaf.getX(), leaf.getY(), leaf.getZ()}, leaf.getSize());
  }
  return bands;
}

}  // namespace lodestar
