#include "planning/uncertainty_constrained_planner.hpp"

#include <cmath>
#include <deque>
#include <gtest/gtest.h>
#include <limits>

#include "maps/random.hpp"
#include "planning/grid_planner.hpp"

#include "tests/planning/sample_maps.hpp"

namespace lodestar {
namespace {

constexpr float blind = std::numeric_limits<float>::infinity();

/// Fix sigma of 1 mm in cells marked '.', no fix in the others; the top row first.
UncertaintyConstraint constraint(const std::vector<std::string>& rows, double limit_m, double drift = 1.0) {
  UncertaintyConstraint result{.fix_sigma_m = {}, .drift_m_per_m = drift, .limit_m = limit_m};
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
    for (const char c : *row) result.fix_sigma_m.push_back(c == '.' ? 0.001F : blind);
  }
  return result;
}

const std::vector<std::string> straight_way_is_blind{"............",  //
                                                     "..      ....",  //
                                                     "..      ....",  //
                                                     "..      ....",  //
                                                     "..      ...."};

GridPlannerOptions options_for(const UncertaintyConstraint& wanted, PlannerKind kind = PlannerKind::astar) {
  return {.kind = kind, .radius_m = 0.0, .clearance_weight = 0.0, .uncertainty_constraint = wanted};
}

OccupancyMap open_floor(const std::vector<std::string>& rows) {
  OccupancyMap map = map_from(rows);
  map.cells.assign(map.cells.size(), OccupancyMap::free);
  return map;
}

class SurePlanner : public ::testing::TestWithParam<PlannerKind> {};

TEST_P(SurePlanner, goes_around_where_it_would_see_nothing_for_too_long) {
  const OccupancyMap map = open_floor(straight_way_is_blind);
  const Vec2 start(0.5, 0.5);
  const Vec2 goal(11.5, 0.5);
  const auto highest = [&](double limit_m) {
    const UncertaintyConstraint wanted = constraint(straight_way_is_blind, limit_m);
    const PlanResult result = GridPlanner(map, options_for(wanted, GetParam())).plan(start, goal);
    const Plan& plan = std::get<Plan>(result);
    double most = 0.0;
    for (const Vec2& point : plan.path.waypoints_m) most = std::max(most, point.y());
    return most;
  };
  EXPECT_LT(highest(7.0), 1.0) << "the 6 m without a fix are within the limit: straight";
  EXPECT_GT(highest(5.0), 4.0) << "they exceed the limit: along the top row";
}

INSTANTIATE_TEST_SUITE_P(Kinds, SurePlanner,
                         ::testing::Values(PlannerKind::astar, PlannerKind::anyangle, PlannerKind::fastest,
                                           PlannerKind::bitstar),
                         [](const auto& kind) { return std::string(to_string(kind.param)); });

TEST(SurePlanner, says_when_no_way_is_sure_enough) {
  const std::vector<std::string> rows{"..   ..", "..   ..", "..   .."};
  const OccupancyMap map = open_floor(rows);
  const auto plan = [&](double limit_m) {
    return GridPlanner(map, options_for(constraint(rows, limit_m))).plan({0.5, 0.5}, {6.5, 2.5});
  };
  ASSERT_TRUE(std::holds_alternative<PlanFailure>(plan(2.5)));
  EXPECT_EQ(std::get<PlanFailure>(plan(2.5)), PlanFailure::unsure);
  EXPECT_TRUE(std::holds_alternative<Plan>(plan(4.0)));
}

/// The cheapest path may violate the constraint although its beginning is cheaper than that of any valid
/// path.
TEST(UncertaintyConstrainedPlanner, takes_the_dearer_way_to_a_place_when_only_that_can_go_on) {
  const std::vector<std::string> rows{".  ....  .",  //
                                      ".        .",  //
                                      ".        ."};
  const OccupancyMap map = open_floor(rows);
  const CollisionChecker space(map, 0.0);
  const CellCosts even;
  const UncertaintyConstrainedPlanner way(space, even, constraint(rows, 3.5));
  const auto found = way.find({0.5, 0.5}, {0, 0}, {9, 0}, {9.5, 0.5});
  ASSERT_TRUE(found);
  bool by_the_top = false;
  for (const Cell cell : found->cells) by_the_top = by_the_top || cell.row == 2;
  EXPECT_TRUE(by_the_top);
}

/// Cost of the cheapest path, by extending every pair of cost and sigma until nothing changes.
double cheapest_by_trying_all(const OccupancyMap& map, const CollisionChecker& space,
                              const UncertaintyConstrainedPlanner& sure, Cell start, Cell goal) {
  struct Way {
    double cost, sigma_m;
  };
  std::vector<std::vector<Way>> ways(map.cells.size());
  std::deque<std::pair<Cell, Way>> open{{start, {0.0, 0.0}}};
  double best = std::numeric_limits<double>::infinity();
  while (!open.empty()) {
    const auto [cell, way] = open.front();
    open.pop_front();
    if (cell == goal) best = std::min(best, way.cost);
    for (int k = 0; k < 9; ++k) {
      const Cell to{cell.column + k % 3 - 1, cell.row + k / 3 - 1};
      if (to == cell || !space.at(to)) continue;
      if (!space.at({to.column, cell.row}) || !space.at({cell.column, to.row})) continue;
      const std::optional<double> sigma_m = sure.along(way.sigma_m, center_of(cell), center_of(to));
      if (!sigma_m) continue;
      const Way next{way.cost + std::hypot(to.column - cell.column, to.row - cell.row), *sigma_m};
      std::vector<Way>& here = ways[map.index(to)];
      const bool beaten = std::ranges::any_of(here, [&](const Way& w) {
        return w.cost <= next.cost + 1e-12 && w.sigma_m <= next.sigma_m + 1e-12;
      });
      if (beaten) continue;
      std::erase_if(here, [&](const Way& w) { return w.cost >= next.cost && w.sigma_m >= next.sigma_m; });
      here.push_back(next);
      open.emplace_back(to, next);
    }
  }
  return best;
}

TEST(UncertaintyConstrainedPlanner, is_as_cheap_as_trying_everything) {
  Random random(11);
  int found = 0;
  int none = 0;
  for (int trial = 0; trial < 60; ++trial) {
    OccupancyMap map = random_map(random, 12, 9, 0.15);
    map.resolution_m = 1.0;
    const CollisionChecker space(map, 0.0);
    UncertaintyConstraint wanted{
        .fix_sigma_m = {}, .drift_m_per_m = 1.0, .limit_m = random.uniform(1.5, 4.0)};
    for (std::size_t i = 0; i < map.cells.size(); ++i)
      wanted.fix_sigma_m.push_back(random.uniform() < 0.25 ? static_cast<float>(random.uniform()) : blind);
    const auto start = clear_cell(random, space);
    const auto goal = clear_cell(random, space);
    if (!start || !goal || space.region(*start) != space.region(*goal)) continue;
    const CellCosts even;
    const UncertaintyConstrainedPlanner way(space, even, wanted);
    const auto path = way.find(center_of(*start), *start, *goal, center_of(*goal));
    const double expected = cheapest_by_trying_all(map, space, way, *start, *goal);
    ASSERT_EQ(path.has_value(), std::isfinite(expected)) << trial;
    (path ? found : none) += 1;
    if (!path) continue;
    EXPECT_NEAR(path->cost, expected, 1e-9);
    std::vector<Vec2> points;
    for (const Cell cell : path->cells) points.push_back(center_of(cell));
    EXPECT_TRUE(way.holds(points));
    const std::vector<Vec2> few = way.shortened(points, 0.0);
    EXPECT_TRUE(way.holds(few));
    EXPECT_EQ(few.back(), points.back());
    for (std::size_t i = 1; i < few.size(); ++i) EXPECT_TRUE(space.along(few[i - 1], few[i]));
  }
  EXPECT_GT(found, 10);
  EXPECT_GT(none, 3);
}

}  // namespace
}  // namespace lodestar
