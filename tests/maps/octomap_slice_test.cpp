#include <algorithm>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include "maps/octomap_file.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

/// A floor, a table over part of it, and known free air.
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
    const Octomap octomap(file);
    const OccupancyMap map = octomap.slice(0.1, 1.0);
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
    const OccupancyMap below = octomap.slice(0.1, 0.7);  // half open: the table begins at 0.7
    EXPECT_EQ(below.at({5, 5}), OccupancyMap::free);
    const OccupancyMap with_floor = octomap.slice(0.0, 0.5);
    EXPECT_EQ(with_floor.at({0, 0}), OccupancyMap::occupied);
  }
}

TEST(OctomapFloor, is_found_below_tables_and_above_noise) {
  const TemporaryFolder folder;
  octomap::OcTree tree(0.1);
  build_room(tree);
  const std::string file = (folder / "room.bt").string();
  ASSERT_TRUE(tree.writeBinary(file));
  ASSERT_TRUE(Octomap(file).floor_m());
  EXPECT_NEAR(*Octomap(file).floor_m(), 0.1, 1e-6);
  for (int i = 0; i < 40; ++i)  // a third of the floor was measured one voxel too high
    tree.setNodeValue(0.05 + 0.1 * (i % 16), 0.05 + 0.1 * (i / 16), 0.15, 3.0F);
  tree.updateInnerOccupancy();
  ASSERT_TRUE(tree.writeBinary(file));
  const Octomap noisy(file);
  EXPECT_NEAR(*noisy.floor_m(), 0.2, 1e-6);
  const OccupancyMap map = noisy.slice(*noisy.floor_m(), 1.0);
  EXPECT_EQ(std::ranges::count(map.cells, OccupancyMap::occupied), 4 * 4) << "the table alone";
}

TEST(OctomapFloor, is_none_where_nothing_has_air_upon_it) {
  const TemporaryFolder folder;
  octomap::OcTree tree(0.1);
  tree.updateNode(0.05, 0.05, 0.05, true);
  ASSERT_TRUE(tree.writeBinary((folder / "one.bt").string()));
  EXPECT_FALSE(Octomap(folder / "one.bt").floor_m());
}

}  // namespace
}  // namespace lodestar
