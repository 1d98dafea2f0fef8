#include "app/placement/plausibility.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

// A hall of 10 m x 4 m, free but for a block of 4 m x 4 m at its east end; the camera looks up from 0.6 m.
namespace lodestar {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

CoveredFloor hall() {
  CoveredFloor floor;
  floor.map = {.columns = 100,
               .rows = 40,
               .resolution_m = 0.1,
               .map_from_grid = {},
               .cells = std::vector<std::int8_t>(4000, OccupancyMap::free)};
  for (int row = 0; row < 40; ++row)
    for (int column = 60; column < 100; ++column)
      floor.map.cells[floor.map.index({column, row})] = OccupancyMap::occupied;
  floor.view = {.camera_height_m = 0.6, .reach_per_m = 1.05, .margin_m = 0.1};
  return floor;
}

RegisteredMarker at(int id, double x_m, double z_m) {
  return {.id = id, .position_m = {x_m, 2.0, z_m}, .yaw_rad = 0.0, .line = 0};
}

/// Three markers of a ceiling at 2.6 m, and one more.
std::vector<RegistryIssue> issues_beside(RegisteredMarker marker) {
  const MarkerRegistry registry{.map_from_registry = {},
                                .markers = {at(1, 1.0, 2.6), at(2, 2.0, 2.6), at(4, 3.0, 2.6), marker}};
  return find_implausible(registry, hall());
}

TEST(Plausibility, nothing_is_said_of_a_ceiling_with_a_small_step) {
  EXPECT_THAT(issues_beside(at(8, 4.0, 3.4)), IsEmpty());
}

TEST(Plausibility, a_marker_below_the_camera_is_an_error) {
  for (const double z_m : {-3.0, 0.5, 0.7}) {
    const auto issues = issues_beside(at(8, 4.0, z_m));
    ASSERT_THAT(issues, SizeIs(1)) << z_m;
    EXPECT_EQ(issues.front().kind, IssueKind::implausible_height);
    EXPECT_TRUE(issues.front().error);
    EXPECT_THAT(issues.front().ids, ElementsAre(8));
    EXPECT_THAT(issues.front().words, HasSubstr("looks up from 0.60 m"));
    EXPECT_THAT(issues.front().places_m, SizeIs(1));
  }
}

TEST(Plausibility, a_height_unlike_those_around_is_a_warning) {
  const auto typo = issues_beside(at(8, 4.0, 26.0));
  ASSERT_THAT(typo, SizeIs(1));
  EXPECT_FALSE(typo.front().error);
  EXPECT_THAT(typo.front().words, HasSubstr("higher than any ceiling"));
  const auto other = issues_beside(at(8, 4.0, 5.2));
  ASSERT_THAT(other, SizeIs(1));
  EXPECT_THAT(other.front().words, HasSubstr("those around hang at 2.60 m"));
}

TEST(Plausibility, a_marker_deep_inside_structure_is_named_and_one_on_a_shelf_is_not) {
  const auto inside = issues_beside(at(8, 8.0, 2.6));
  ASSERT_THAT(inside, SizeIs(1));
  EXPECT_EQ(inside.front().kind, IssueKind::inside_structure);
  EXPECT_THAT(issues_beside(at(8, 6.2, 2.6)), IsEmpty());  // 0.3 m over what is built
}

TEST(Plausibility, with_heights_a_marker_over_a_low_cupboard_is_fine_and_one_in_a_high_one_is_not) {
  CoveredFloor floor = hall();
  // Bands of 0.1 m from the floor up: built to 2.0 m everywhere in the block.
  HeightBands heights{.low_m = 0.0, .step_m = 0.1, .touch_m = 0.0, .cells = {}};
  heights.cells.assign(floor.map.cells.size(), 0U);
  for (std::size_t i = 0; i < heights.cells.size(); ++i)
    if (floor.map.cells[i] == OccupancyMap::occupied) heights.cells[i] = (1U << 20U) - 1U;
  floor.heights = heights;
  EXPECT_THAT(find_implausible({.map_from_registry = {}, .markers = {at(8, 8.0, 2.6)}}, floor), IsEmpty());
  EXPECT_THAT(find_implausible({.map_from_registry = {}, .markers = {at(8, 8.0, 1.5)}}, floor), SizeIs(1));
}

}  // namespace
}  // namespace lodestar
