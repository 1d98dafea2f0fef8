#include "maps/map_overlay.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <vector>

namespace lodestar {
namespace {

/// 4 m x 4 m at 5 cm, an occupied column at x = 2, all beyond x = 3 unknown.
OccupancyMap one_wall() {
  OccupancyMap map{.columns = 80, .rows = 80, .resolution_m = 0.05, .map_from_grid = {}, .cells = {}};
  map.cells.assign(6400, OccupancyMap::free);
  for (int row = 0; row < 80; ++row) {
    map.cells[map.index({40, row})] = OccupancyMap::occupied;
    for (int column = 60; column < 80; ++column) map.cells[map.index({column, row})] = OccupancyMap::unknown;
  }
  return map;
}

TEST(MapExplanation, OnlyWhatIsNearAnOccupiedCellIsExplained) {
  const ObstacleField field(one_wall());
  const MapExplanation certain(field, Eigen::Matrix3d::Zero());  // 3 x 15 mm + 50 mm
  EXPECT_TRUE(certain.explains({1.91, 2.0}, 1.0));
  EXPECT_FALSE(certain.explains({1.89, 2.0}, 1.0));
  EXPECT_FALSE(certain.explains({3.5, 2.0}, 1.0));  // unknown explains nothing
  EXPECT_FALSE(certain.explains({-5.0, 2.0}, 1.0));
  const MapExplanation uncertain(field, Eigen::Vector3d(1e-3, 1e-3, 0.0).asDiagonal().toDenseMatrix());
  EXPECT_TRUE(uncertain.explains({1.86, 2.0}, 1.0));
  const MapExplanation lost(field, Eigen::Vector3d(1.0, 1.0, 1.0).asDiagonal().toDenseMatrix());
  EXPECT_FALSE(lost.explains({1.79, 2.0}, 1.0));
}

TEST(Overlaid, MarksTheCellsAndPassesOverWhatIsBeside) {
  const std::vector<Vec2> points_m{{0.52, 0.52}, {-1.0, 0.0}};
  const OccupancyMap map = overlaid(one_wall(), points_m);
  EXPECT_EQ(map.at({10, 10}), OccupancyMap::occupied);
  EXPECT_EQ(std::ranges::count(map.cells, OccupancyMap::occupied), 81);
}

TEST(Split, HasTheSameValueEverywhereOnSmallerCells) {
  OccupancyMap map = one_wall();
  map.map_from_grid = {{1.0, -2.0}, 0.3};
  const OccupancyMap finer = split(map, 3);
  EXPECT_EQ(finer.cells.size(), 9 * map.cells.size());
  for (double x_m = 0.01; x_m < 4.0; x_m += 0.013) {
    const Vec2 point_m = map.map_from_grid * Vec2(x_m, 0.5 * x_m);
    EXPECT_EQ(finer.at(finer.cell_at(point_m)), map.at(map.cell_at(point_m))) << x_m;
  }
}

}  // namespace
}  // namespace lodestar
