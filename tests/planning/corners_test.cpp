#include "planning/corners.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "tests/planning/sample_maps.hpp"

namespace lodestar {
namespace {

constexpr double radius_m = 0.17;

bool is_obstacle(const OccupancyMap& map, int column, int row) {
  return !is_drivable(map.at({column, row}));
}

/// Signs of the quadrant away from the obstacle when one of the four cells around a grid point is one.
std::optional<Vec2> away_from_corner(const OccupancyMap& map, int column, int row) {
  std::vector<Vec2> away;
  for (const int right : {0, 1})
    for (const int up : {0, 1})
      if (is_obstacle(map, column - 1 + right, row - 1 + up))
        away.emplace_back(right == 0 ? 1.0 : -1.0, up == 0 ? 1.0 : -1.0);
  return away.size() == 1 ? std::optional(away.front()) : std::nullopt;
}

Vec2 on_arc(const Vec2& corner, const Vec2& away, double degrees, double reach) {
  return corner + reach * away.cwiseProduct(Vec2(std::cos(radians(degrees)), std::sin(radians(degrees))));
}

/// Random single cells, from a few to so many that hardly an arc is clear.
template <typename Story>
void on_maps_of_posts(Story story) {
  Random random(5);
  for (const double share : {0.002, 0.01, 0.03, 0.08}) {
    for (int trial = 0; trial < 8; ++trial) {
      const OccupancyMap map = random_map(random, 90, 40, share);
      const CollisionChecker space(map, radius_m);
      story(map, space, turn_points(space, space.radius_cells()));
    }
  }
}

TEST(TurnPoints, are_clear) {
  int points = 0;
  on_maps_of_posts([&](const OccupancyMap& map, const CollisionChecker&,
                       const std::vector<TurnPoint>& found) {
    for (const TurnPoint& point : found) {
      ++points;
      EXPECT_FALSE(touches(map, map.resolution_m * point.position, radius_m)) << point.position.transpose();
    }
  });
  EXPECT_GT(points, 2000);
}

TEST(TurnPoints, are_three_and_one_around_each_corner_whose_arc_is_clear) {
  int arcs = 0;
  on_maps_of_posts(
      [&](const OccupancyMap& map, const CollisionChecker& space, const std::vector<TurnPoint>& found) {
        for (int row = 1; row < map.rows; ++row) {
          for (int column = 1; column < map.columns; ++column) {
            const std::optional<Vec2> away = away_from_corner(map, column, row);
            if (!away) continue;
            const Vec2 corner(column, row);
            const auto is_clear = [&](double degrees, double stretched) {
              const double reach = (space.radius_cells() + 1e-6) * stretched;
              return !touches(map, map.resolution_m * on_arc(corner, *away, degrees, reach), radius_m);
            };
            bool is_open = true;
            for (int degrees = 0; degrees <= 90; degrees += 5) is_open = is_open && is_clear(degrees, 1.0);
            if (!is_open) continue;
            ++arcs;
            const double between = 1.0 / std::cos(radians(15.0));
            auto wanted = std::ranges::count_if(std::vector{15.0, 45.0, 75.0},
                                                [&](double degrees) { return is_clear(degrees, between); });
            if (is_clear(45.0, std::sqrt(2.0))) ++wanted;
            EXPECT_EQ(wanted, std::ranges::count(found, corner, &TurnPoint::corner)) << corner.transpose();
          }
        }
      });
  EXPECT_GT(arcs, 500);
}

}  // namespace
}  // namespace lodestar
