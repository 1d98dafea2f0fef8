#include "app/placement/fill.hpp"

#include <gtest/gtest.h>

#include "app/site/floor_plan.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

/// A hall under a camera at 1.1 m that sees 0.75 m around for each metre above it.
CoveredFloor hall() {
  return {.map = empty_hall(6.0, 4.0, 0.05),
          .heights = std::nullopt,
          .room_m = 0.25,
          .view = {.camera_height_m = 1.1, .reach_per_m = 0.75, .margin_m = 0.2},
          .routes = {}};
}

TEST(Fill, leaves_no_gap_by_the_check_s_own_measure_and_adds_nothing_twice) {
  MarkerRegistry registry;
  registry.map_from_registry = {{1.0, -2.0}, 0.5};  // an aligned registry: places are turned into its frame
  ASSERT_FALSE(find_gaps(registry, hall()).empty());
  const Filling filling = fill_gaps(registry, hall(), {.ceiling_m = 2.6});
  EXPECT_EQ(filling.uncovered_m2, 0.0);
  registry.markers = filling.added;
  EXPECT_TRUE(find_gaps(registry, hall()).empty());
  EXPECT_LT(filling.added.size(), 60U);
  EXPECT_TRUE(fill_gaps(registry, hall(), {.ceiling_m = 2.6}).added.empty());
}

TEST(Fill, keeps_sheets_apart_and_refuses_a_ceiling_that_no_camera_sees) {
  const Filling filling = fill_gaps({}, hall(), {.ceiling_m = 2.6, .wanted = 3});
  for (const RegisteredMarker& one : filling.added) {
    for (const RegisteredMarker& other : filling.added) {
      if (one.id == other.id) continue;
      EXPECT_GE((one.position_m - other.position_m).norm(), 0.5 - 1e-9);
    }
  }
  EXPECT_THROW((void)fill_gaps({}, hall(), {.ceiling_m = 1.2}), InputError);
}

}  // namespace
}  // namespace lodestar
