#include "planning/sampling_search.hpp"

#include <gtest/gtest.h>

#include "planning/grid_planner.hpp"

#include "tests/planning/sample_maps.hpp"

namespace lodestar {
namespace {

class Sampling : public testing::TestWithParam<PlannerKind> {
 protected:
  static GridPlannerOptions options(std::uint32_t seed) {
    return {.kind = GetParam(),
            .radius_m = 0.1,
            .clearance_weight = 0.0,
            .sampling = {.seed = seed, .max_iterations = 1000}};
  }
  /// A wall with a gap of 50 cm.
  static OccupancyMap wall() {
    std::vector<std::string> rows(40, std::string(60, '.'));
    for (std::size_t row = 0; row < 40; ++row) {
      if (row < 25 || row > 34) rows[row][30] = '#';
    }
    return map_from(rows, 0.05);
  }
};

TEST_P(Sampling, finds_a_clear_path_through_the_gap) {
  const OccupancyMap map = wall();
  const GridPlanner planner(map, options(1));
  const PlanResult result = planner.plan({0.3, 1.7}, {2.7, 1.7});
  ASSERT_TRUE(std::holds_alternative<Plan>(result));
  const auto& points = std::get<Plan>(result).path.waypoints_m;
  EXPECT_EQ(points.front(), Vec2(0.3, 1.7));
  EXPECT_EQ(points.back(), Vec2(2.7, 1.7));
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_TRUE(planner.is_clear(points[i - 1], points[i]));
}

TEST_P(Sampling, gives_the_same_path_for_the_same_seed_and_another_for_another) {
  const OccupancyMap map = wall();
  const auto points = [&](std::uint32_t seed) {
    const PlanResult result = GridPlanner(map, options(seed)).plan({0.3, 1.7}, {2.7, 1.7});
    return std::get<Plan>(result).path.waypoints_m;
  };
  const auto first = points(7);
  EXPECT_EQ(first, points(7));
  EXPECT_NE(first, points(8));
}

TEST_P(Sampling, does_not_take_a_path_that_only_comes_near_for_one) {
  OccupancyMap map = wall();
  GridPlannerOptions hasty = options(1);
  hasty.sampling.max_iterations = 2;
  const PlanResult result = GridPlanner(map, hasty).plan({0.3, 1.7}, {2.7, 1.7});
  ASSERT_TRUE(std::holds_alternative<PlanFailure>(result));
  EXPECT_EQ(std::get<PlanFailure>(result), PlanFailure::limit_reached);
}

TEST_P(Sampling, stops_as_soon_as_the_path_is_short_enough) {
  const OccupancyMap map = wall();
  GridPlannerOptions content = options(1);
  content.sampling.enough_length_m = 100.0;
  const PlanResult result = GridPlanner(map, content).plan({0.3, 1.7}, {2.7, 1.7});
  ASSERT_TRUE(std::holds_alternative<Plan>(result));
  EXPECT_LT(std::get<Plan>(result).expanded, 900U);
}

INSTANTIATE_TEST_SUITE_P(Planners, Sampling,
                         testing::Values(PlannerKind::rrtstar, PlannerKind::informedrrtstar,
                                         PlannerKind::bitstar, PlannerKind::abitstar, PlannerKind::prmstar),
                         [](const auto& kind) { return std::string(to_string(kind.param)); });

TEST(PlannerKinds, have_names_that_lead_back) {
  for (const PlannerKind kind : all_planner_kinds()) EXPECT_EQ(planner_kind(to_string(kind)), kind);
  EXPECT_EQ(planner_kind("dstar"), std::nullopt);
}

}  // namespace
}  // namespace lodestar
