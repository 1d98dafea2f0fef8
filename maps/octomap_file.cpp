#include "maps/octomap_file.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <memory>

#include "maps/input_error.hpp"
#include "maps/octree_file.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

/// Columns and rows of voxels that a leaf covers, in voxel indices from the tree's lowest corner.
struct LeafExtent {
  Cell low;
  int side = 1;
};

class Slicer {
 public:
  Slicer(const octomap::OcTree& tree, OccupancyMap& map) : resolution_m_(tree.getResolution()), map_(map) {
    Vec3 low;
    Vec3 high;
    tree.getMetricMin(low.x(), low.y(), low.z());
    tree.getMetricMax(high.x(), high.y(), high.z());
    map_.resolution_m = resolution_m_;
    map_.columns = static_cast<int>(std::lround((high.x() - low.x()) / resolution_m_));
    map_.rows = static_cast<int>(std::lround((high.y() - low.y()) / resolution_m_));
    map_.map_from_grid.position_m = low.head<2>();
    const auto cells = static_cast<std::size_t>(map_.columns) * static_cast<std::size_t>(map_.rows);
    map_.cells.assign(cells, OccupancyMap::unknown);
  }

  void add(const octomap::OcTree::leaf_iterator& leaf, bool occupied) {
    const double size_m = leaf.getSize();
    const Vec2 corner = Vec2(leaf.getX(), leaf.getY()).array() - 0.5 * size_m;
    const Vec2 index = (corner - map_.map_from_grid.position_m) / resolution_m_;
    const LeafExtent extent{
        {static_cast<int>(std::lround(index.x())), static_cast<int>(std::lround(index.y()))},
        static_cast<int>(std::lround(size_m / resolution_m_))};
    fill(extent, occupied);
  }

 private:
  void fill(const LeafExtent& extent, bool occupied) {
    const int end_row = std::min(extent.low.row + extent.side, map_.rows);
    const int end_column = std::min(extent.low.column + extent.side, map_.columns);
    for (int row = std::max(extent.low.row, 0); row < end_row; ++row) {
      for (int column = std::max(extent.low.column, 0); column < end_column; ++column) {
        std::int8_t& cell = map_.cells[map_.index({column, row})];
        if (occupied || cell == OccupancyMap::unknown)
          cell = occupied ? OccupancyMap::occupied : OccupancyMap::free;
      }
    }
  }

  double resolution_m_;
  OccupancyMap& map_;
};

/// Is the voxel above this column of the leaf known to be free?
bool is_free_above(const octomap::OcTree& tree, double x_m, double y_m, double top_m) {
  const octomap::OcTreeNode* above = tree.search(x_m, y_m, top_m + 0.5 * tree.getResolution());
  return above != nullptr && !tree.isNodeOccupied(*above);
}

/// Number of occupied voxels with free space above them in each layer, by the layer's top in voxels.
std::map<int, int> surfaces_of(const octomap::OcTree& tree) {
  std::map<int, int> surfaces;
  const double voxel_m = tree.getResolution();
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    const double half_m = 0.5 * leaf.getSize();
    const double top_m = leaf.getZ() + half_m;
    const int columns = static_cast<int>(std::lround(leaf.getSize() / voxel_m));
    for (int i = 0; i < columns * columns; ++i) {
      const int column = i % columns;
      const int row = i / columns;
      const double x_m = leaf.getX() - half_m + (column + 0.5) * voxel_m;
      const double y_m = leaf.getY() - half_m + (row + 0.5) * voxel_m;
      if (is_free_above(tree, x_m, y_m, top_m)) ++surfaces[static_cast<int>(std::lround(top_m / voxel_m))];
    }
  }
  return surfaces;
}

}  // namespace

Octomap::Octomap(const fs::path& file) : file_(file), tree_(read_octree(file)) {}

OctomapInfo Octomap::info() const {
  OctomapInfo info;
  info.resolution_m = tree_->getResolution();
  for (auto leaf = tree_->begin_leafs(); leaf != tree_->end_leafs(); ++leaf) {
    ++(tree_->isNodeOccupied(*leaf) ? info.leaves_occupied : info.leaves_free);
  }
  tree_->getMetricMin(info.low_m.x(), info.low_m.y(), info.low_m.z());
  tree_->getMetricMax(info.high_m.x(), info.high_m.y(), info.high_m.z());
  return info;
}

std::optional<double> Octomap::floor_m() const {
  const std::map<int, int> surfaces = surfaces_of(*tree_);
  if (surfaces.empty()) return std::nullopt;
  const auto area = [](const auto& layer) { return layer.second; };
  auto floor = std::ranges::max_element(surfaces, {}, area);
  const int largest = floor->second;
  for (auto next = std::next(floor); next != surfaces.end(); floor = next++) {
    if (next->first != floor->first + 1 || 5 * next->second < largest) break;
  }
  return floor->first * tree_->getResolution();
}

OccupancyMap Octomap::slice(double z_min_m, double z_max_m) const {
  if (!(z_min_m < z_max_m)) {
    throw InputError(fmt::format(
        "found a slab from {} m to {} m, wanted its lower height below its upper one", z_min_m, z_max_m));
  }
  OccupancyMap map;
  Slicer slicer(*tree_, map);
  const double touch_m =
      1e-6 * tree_->getResolution();  // voxels that only touch the slab's limits do not count
  bool any = false;
  for (auto leaf = tree_->begin_leafs(); leaf != tree_->end_leafs(); ++leaf) {
    const double half_m = 0.5 * leaf.getSize();
    const bool within = leaf.getZ() + half_m > z_min_m + touch_m && leaf.getZ() - half_m < z_max_m - touch_m;
    if (!within) continue;
    any = true;
    slicer.add(leaf, tree_->isNodeOccupied(*leaf));
  }
  if (!any) {
    throw InputError(file_, 0, fmt::format("nothing known from {} m to {} m", z_min_m, z_max_m),
                     "a slab within the map");
  }
  return map;
}

}  // namespace lodestar
