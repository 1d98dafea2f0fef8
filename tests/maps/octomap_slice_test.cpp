#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include "maps/octomap_file.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

/// A floor, a table over part of it, and air known to be free.
void build_room(octomap::OcTree& tree) {
  for (int x = 0; x < 16; ++x) {
    for (int y = 0; y < 8; ++y) {
      for (int z = 0; z < 16; ++z) {
        const bool floor = z == 0;
        const bool table = z == 7 && x >= 4 && x < 8 && y >= 4;
        tree.updateNode(
            octomap::point3d(0.05F + 0.1F * static_cast<float>(x), 0.05F + 0.1F * static_cast<float>(y),
                             0.05F + 0.1F * static_cast<float>(z)),
            floor || table);
      }
    }
  }
  tree.updateInnerOccupancy();
  tree.prune();  // so that some leaves are larger than a voxel
}

TEST(OctomapSlice, sees_the_table_and_not_the_floor) {
  const TemporaryFolder folder;
  octomap::OcTree tree(0.1);
  build_room(tree);
  for (const std::string name : {"room.bt", "room.ot"}) {
    const std::string file = (folder / name).string();
    ASSERT_TRUE(name == "room.bt" ? tree.writeBinary(file) : tree.write(file));
    const OccupancyMap map = octomap_slice(file, 0.1, 1.0);
    ASSERT_EQ(map.columns, 16);
    ASSERT_EQ(map.rows, 8);
    EXPECT_NEAR(map.map_from_grid.position_m.norm(), 0.0, 1e-6);
    for (int row = 0; row < 8; ++row) {
      for (int column = 0; column < 16; ++column) {
        const bool table = column >= 4 && column < 8 && row >= 4;
        EXPECT_EQ(map.at({column, row}), table ? OccupancyMap::occupied : OccupancyMap::free)
            << name << " " << column << " " << row;
      }
    }
    const OccupancyMap below = octomap_slice(file, 0.1, 0.7);  // half open: the table begins at 0.7
    EXPECT_EQ(below.at({5, 5}), OccupancyMap::free);
    const OccupancyMap with_floor = octomap_slice(file, 0.0, 0.5);
    EXPECT_EQ(with_floor.at({0, 0}), OccupancyMap::occupied);
  }
}

}  // namespace
}  // namespace lodestar
