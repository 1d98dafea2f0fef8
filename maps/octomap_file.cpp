#include "maps/octomap_file.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <octomap/OcTree.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, const std::string& found) {
  throw InputError(file, 0, found, "an OctoMap .bt or .ot file");
}

/// The library prints to the standard streams and returns nothing on most errors; a few it throws.
std::unique_ptr<octomap::OcTree> read_tree(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || fs::is_directory(file)) refuse(file, "no file that can be read");
  std::string first_line;
  std::getline(stream, first_line);
  stream.seekg(0);
  std::unique_ptr<octomap::OcTree> tree;
  try {
    if (first_line.starts_with("# Octomap OcTree binary file")) {
      tree = std::make_unique<octomap::OcTree>(0.1);
      if (!tree->readBinary(stream)) tree.reset();
    } else if (first_line.starts_with("# Octomap OcTree file")) {
      std::unique_ptr<octomap::AbstractOcTree> any(octomap::AbstractOcTree::read(stream));
      if (dynamic_cast<octomap::OcTree*>(any.get()) != nullptr) {
        tree.reset(dynamic_cast<octomap::OcTree*>(any.release()));
      }
    } else {
      refuse(file, "another first line");
    }
  } catch (const std::bad_alloc&) {
    tree.reset();
  }
  if (!tree || tree->size() == 0) refuse(file, "a broken or empty tree");
  return tree;
}

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

}  // namespace

OctomapInfo octomap_info(const fs::path& file) {
  const std::unique_ptr<octomap::OcTree> tree = read_tree(file);
  OctomapInfo info;
  info.resolution_m = tree->getResolution();
  for (auto leaf = tree->begin_leafs(); leaf != tree->end_leafs(); ++leaf) {
    ++(tree->isNodeOccupied(*leaf) ? info.leaves_occupied : info.leaves_free);
  }
  tree->getMetricMin(info.low_m.x(), info.low_m.y(), info.low_m.z());
  tree->getMetricMax(info.high_m.x(), info.high_m.y(), info.high_m.z());
  return info;
}

OccupancyMap octomap_slice(const fs::path& file, double z_min_m, double z_max_m) {
  if (!(z_min_m < z_max_m)) {
    throw InputError(fmt::format(
        "found a slab from {} m to {} m, wanted its lower height below its upper one", z_min_m, z_max_m));
  }
  const std::unique_ptr<octomap::OcTree> tree = read_tree(file);
  OccupancyMap map;
  Slicer slicer(*tree, map);
  const double touch_m = 1e-6 * tree->getResolution();  // faces at the slab's very limits do not count
  bool any = false;
  for (auto leaf = tree->begin_leafs(); leaf != tree->end_leafs(); ++leaf) {
    const double half_m = 0.5 * leaf.getSize();
    const bool within = leaf.getZ() + half_m > z_min_m + touch_m && leaf.getZ() - half_m < z_max_m - touch_m;
    if (!within) continue;
    any = true;
    slicer.add(leaf, tree->isNodeOccupied(*leaf));
  }
  if (!any) {
    throw InputError(file, 0, fmt::format("nothing known from {} m to {} m", z_min_m, z_max_m),
                     "a slab within the map");
  }
  return map;
}

}  // namespace lodestar
