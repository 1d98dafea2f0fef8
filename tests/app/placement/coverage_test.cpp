#include "app/placement/coverage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/placement/site_floor.hpp"

// A hall of 10 m x 2 m with results that can be computed by hand: the robot's centre keeps 0.2 m off the
// walls, and a marker at 2.6 m is seen within 2 m of its centre by a camera at 0.6 m.
namespace lodestar {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

CoveredFloor hall() {
  CoveredFloor floor;
  floor.map = {.columns = 100,
               .rows = 20,
               .resolution_m = 0.1,
               .map_from_grid = {},
               .cells = std::vector<std::int8_t>(2000, OccupancyMap::free)};
  floor.room_m = 0.2;
  floor.view = {.camera_height_m = 0.6, .reach_per_m = 1.05, .margin_m = 0.1};
  floor.routes = {Path{{{0.5, 1.0}, {9.5, 1.0}}}};
  return floor;
}

/// A marker centred here: its dot O is 6 cm west and north of the centre.
RegisteredMarker over(int id, double x_m, double y_m) {
  return {.id = id, .position_m = {x_m - 0.06, y_m + 0.06, 2.6}, .yaw_rad = 0.0, .line = 0};
}

MarkerRegistry with(std::vector<RegisteredMarker> markers) {
  return {.map_from_registry = {}, .markers = std::move(markers)};
}

void wall_at(OccupancyMap& map, int column) {
  for (int row = 0; row < map.rows; ++row) map.cells[map.index({column, row})] = OccupancyMap::occupied;
}

TEST(Coverage, a_hall_without_markers_is_one_gap_and_its_route_one_blind_stretch) {
  const CoveredFloor floor = hall();
  EXPECT_DOUBLE_EQ(floor.view.reach_m(2.6), 2.0);
  const auto gaps = find_gaps({}, floor);
  ASSERT_THAT(gaps, SizeIs(1));
  // 0.2 m off the outside of the map, measured from cell to cell: 96 by 16 cells.
  EXPECT_THAT(gaps.front().words, HasSubstr("15.4 m² near"));
  EXPECT_LT((gaps.front().places_m.front() - Vec2(0.25, 0.25)).norm(), 1e-9);
  EXPECT_LT((gaps.front().places_m.back() - Vec2(9.75, 1.75)).norm(), 1e-9);
  const auto stretches = find_blind_stretches({}, floor);
  ASSERT_THAT(stretches, SizeIs(1));
  EXPECT_EQ(stretches.front().words, "the usual route sees no marker for 9.0 m from 0.5, 1.0 m");
  EXPECT_THAT(stretches.front().places_m, ElementsAre(Vec2(0.5, 1.0), Vec2(9.5, 1.0)));
}

TEST(Coverage, markers_that_reach_each_other_leave_no_gap) {
  const CoveredFloor floor = hall();
  const MarkerRegistry three = with({over(1, 1.6, 1.0), over(2, 5.0, 1.0), over(7, 8.4, 1.0)});
  EXPECT_THAT(find_gaps(three, floor), IsEmpty());
  EXPECT_THAT(find_blind_stretches(three, floor), IsEmpty());

  MarkerRegistry aligned = with({over(1, 0.6, 0.0), over(2, 4.0, 0.0), over(7, 7.4, 0.0)});
  aligned.map_from_registry = {{1.0, 1.0}, 0.0};
  EXPECT_THAT(find_gaps(aligned, floor), IsEmpty()) << "the registry's alignment to the map counts";
}

TEST(Coverage, a_stretch_counts_when_the_wheels_would_have_to_carry_the_robot_for_more_than_a_metre) {
  CoveredFloor floor = hall();
  const auto stretch_between = [&](double gap_m) {
    return find_blind_stretches(with({over(1, 2.4, 1.0), over(2, 6.4 + gap_m, 1.0)}), floor);
  };
  EXPECT_THAT(stretch_between(0.9), IsEmpty());
  floor.routes = {Path{{{0.5, 1.0}, {8.0, 1.0}}}, Path{{{8.0, 1.0}, {0.5, 1.0}}}};
  const auto stretches = stretch_between(1.2);
  ASSERT_THAT(stretches, SizeIs(1)) << "there and back is the same stretch";
  EXPECT_NEAR(stretches.front().places_m.front().x(), 4.4, 0.051);
  EXPECT_NEAR(stretches.front().places_m.back().x(), 5.6, 0.051);
}

TEST(Coverage, walls_hide_markers_but_for_those_that_hang_over_them) {
  CoveredFloor floor = hall();
  wall_at(floor.map, 50);
  const auto blind_east = [&](double marker_x_m) {
    const auto gaps = find_gaps(with({over(1, marker_x_m, 1.0)}), floor);
    return std::ranges::any_of(gaps, [](const RegistryIssue& gap) {
      return gap.places_m.front().x() > 5.0 && gap.places_m.front().x() < 5.5;
    });
  };
  EXPECT_TRUE(blind_east(4.5));
  EXPECT_FALSE(blind_east(5.05));
}

/// The same wall, which ends 2 m above the floor by the OctoMap.
TEST(Coverage, where_heights_are_known_only_what_stands_in_the_line_of_sight_hides) {
  CoveredFloor floor = hall();
  HeightBands heights{.low_m = 0.0,
                      .step_m = 0.1,
                      .touch_m = 0.15,
                      .cells = std::vector<std::uint32_t>(floor.map.cells.size(), 0)};
  for (int row = 0; row < floor.map.rows; ++row) heights.cells[floor.map.index({50, row})] = (1U << 20U) - 1U;
  floor.heights = heights;
  floor.routes = {Path{{{5.15, 1.0}, {6.4, 1.0}}}};
  EXPECT_THAT(find_blind_stretches(with({over(1, 4.5, 1.0)}), floor), SizeIs(1)) << "0.5 m behind the wall";
  for (std::uint32_t& cell : floor.heights->cells) cell &= (1U << 8U) - 1U;  // now 0.8 m high
  EXPECT_THAT(find_blind_stretches(with({over(1, 4.5, 1.0)}), floor), IsEmpty());
}

TEST(Coverage, of_the_lab_is_along_its_route_and_that_of_a_robot_with_an_outline_fits_its_narrow_side) {
  Site lab = load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
  const CoveredFloor floor = covered_floor(lab);
  EXPECT_EQ(floor.routes.size(), lab.goals.size());
  EXPECT_EQ(floor.room_m, lab.robot.radius_m);
  EXPECT_THAT(find_blind_stretches({}, floor), testing::Not(IsEmpty()));

  lab.goals.clear();
  lab.robot.footprint = Footprint({{-0.4, -0.2}, {0.4, -0.2}, {0.4, 0.2}, {-0.4, 0.2}});
  EXPECT_DOUBLE_EQ(covered_floor(lab).room_m, 0.2);
}

TEST(Coverage, is_checked_together_with_all_else) {
  const auto issues = check_coverage(with({over(1, 1.6, 1.0), over(1, 40.0, 1.0)}), hall());
  std::vector<IssueKind> kinds;
  for (const RegistryIssue& issue : issues) kinds.push_back(issue.kind);
  EXPECT_THAT(kinds, ElementsAre(IssueKind::repeated_id, IssueKind::outside_map, IssueKind::blind_route,
                                 IssueKind::gap));
}

}  // namespace
}  // namespace lodestar
