#include "maps/height_bands.hpp"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include "maps/input_error.hpp"

#include "tests/maps/empty_floor.hpp"
#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

/// 4 m x 2 m in cells of 0.2 m; height bands from 1 m up.
OccupancyMap floor_map() {
  return empty_floor(20, 10, 0.2);
}

class HeightBandsTest : public ::testing::Test {
 protected:
  /// An OctoMap with these places occupied.
  std::filesystem::path octomap(const std::vector<Vec3>& occupied, double voxel_m = 0.1) {
    octomap::OcTree tree(voxel_m);
    for (const Vec3& at : occupied) {
      tree.updateNode(octomap::point3d(static_cast<float>(at.x()), static_cast<float>(at.y()),
                                       static_cast<float>(at.z())),
                      true);
    }
    tree.updateInnerOccupancy();
    std::filesystem::path file = folder_ / "place.bt";
    tree.writeBinary(file.string());
    return file;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(HeightBandsTest, a_voxel_sets_its_band_in_its_cell_and_no_other) {
  const OccupancyMap map = floor_map();
  const HeightBands bands = height_bands(octomap({{1.25, 0.65, 1.55}}), map, 1.0, 4.2);
  EXPECT_NEAR(bands.step_m, 0.1, 1e-9);
  EXPECT_NEAR(bands.touch_m, 0.18, 1e-9);
  for (std::size_t i = 0; i < bands.cells.size(); ++i) {
    EXPECT_EQ(bands.cells[i], i == map.index({6, 3}) ? 1U << 5U : 0U) << i;
  }
}

TEST_F(HeightBandsTest, bands_are_as_high_as_it_takes_to_reach_the_top) {
  const HeightBands bands = height_bands(octomap({{1.25, 0.65, 8.05}}), floor_map(), 1.0, 9.0);
  EXPECT_NEAR(bands.step_m, 0.25, 1e-9);
  EXPECT_EQ(bands.cells[floor_map().index({6, 3})], 1U << 28U);  // 8.00 to 8.10 m
}

TEST_F(HeightBandsTest, what_is_below_above_or_beside_is_left_out) {
  const auto file = octomap({{1.25, 0.65, 0.55}, {1.25, 0.65, 7.05}, {-1.0, 0.65, 1.55}, {1.25, 9.0, 1.55}});
  const std::vector<std::uint32_t> cells = height_bands(file, floor_map(), 1.0, 4.2).cells;
  EXPECT_EQ(cells.size(), floor_map().cells.size());
  for (const std::uint32_t bits : cells) EXPECT_EQ(bits, 0U);
}

TEST_F(HeightBandsTest, a_large_voxel_covers_all_cells_below_it) {
  const HeightBands bands = height_bands(octomap({{1.2, 0.4, 1.2}}, 0.8), floor_map(), 0.8, 4.0);
  for (const Cell cell : {Cell{4, 0}, Cell{7, 0}, Cell{4, 3}, Cell{7, 3}})
    EXPECT_EQ(bands.cells[floor_map().index(cell)], 1U) << cell.column << " " << cell.row;
  for (const Cell cell : {Cell{3, 0}, Cell{8, 0}, Cell{4, 4}})
    EXPECT_EQ(bands.cells[floor_map().index(cell)], 0U) << cell.column << " " << cell.row;
}

TEST_F(HeightBandsTest, a_map_that_lies_turned_gets_them_in_its_own_cells) {
  OccupancyMap map = floor_map();
  map.map_from_grid = {{2.0, 0.0}, radians(90.0)};  // columns run to the north, rows to the west
  const HeightBands bands = height_bands(octomap({{1.25, 0.65, 1.55}}), map, 1.0, 4.2);
  EXPECT_EQ(bands.cells[map.index({3, 3})], 1U << 5U);
}

TEST_F(HeightBandsTest, a_file_that_is_none_is_an_input_error) {
  EXPECT_THROW(height_bands("/nowhere.bt", floor_map(), 1.0, 4.0), InputError);
}

}  // namespace
}  // namespace lodestar
