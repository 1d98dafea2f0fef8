#include "app/placement/installation.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/placement/registry_check.hpp"
#include "app/site/floor_plan.hpp"

namespace lodestar {
namespace {

TEST(Installation, measures_to_the_faces_of_the_walls) {
  const OccupancyMap hall = empty_hall(6.0, 4.0, 0.05);
  const WallDistances walls = wall_distances(hall, {1.25, 3.0});
  EXPECT_NEAR(walls.left_m.value(), 1.25, 1e-9);
  EXPECT_NEAR(walls.right_m.value(), 4.75, 1e-9);
  EXPECT_NEAR(walls.below_m.value(), 3.0, 1e-9);
  EXPECT_NEAR(walls.above_m.value(), 1.0, 1e-9);
  EXPECT_FALSE(wall_distances(hall, {-3.0, 1.0}).right_m);
}

TEST(Installation, names_the_nearer_walls_of_the_square_s_centre_in_the_table) {
  const OccupancyMap hall = empty_hall(6.0, 4.0, 0.05);
  const MarkerRegistry registry{.markers = {{.id = 7, .position_m = {1.0, 3.0, 2.6}, .yaw_rad = 0.0}}};
  const Vec3 center_m = center_in_map(registry, registry.markers.front());
  const std::string expected =
      fmt::format("7,{0:.3f},{1:.3f},2.600,0.0,left,{0:.3f},above,{2:.3f},down,\"hall, north\",today\n",
                  center_m.x(), center_m.y(), 4.0 - center_m.y());
  EXPECT_THAT(installation_csv(registry, hall, "hall, north", "today"), testing::HasSubstr(expected));
}

}  // namespace
}  // namespace lodestar
