#include "app/site/route_graph.hpp"

#include <gtest/gtest.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

///  C --- D      A to B and B to D both ways, D to C and C to A one way; C to D does not exist.
///  |     |
///  A --- B
Places square() {
  Places places;
  places.places = {{"A", {0.0, 0.0}, std::nullopt}, {"D", {4.0, 4.0}, 1.5}};
  places.nodes = {{"B", {4.0, 0.0}}, {"C", {0.0, 4.0}}};
  places.edges = {{"A", "B", false, std::nullopt},
                  {"B", "D", false, 0.3},
                  {"D", "C", true, std::nullopt},
                  {"C", "A", true, std::nullopt}};
  return places;
}

std::vector<Vec2> positions_m(const std::vector<Goal>& goals) {
  std::vector<Vec2> positions_m;
  for (const Goal& goal : goals) positions_m.push_back(goal.position_m);
  return positions_m;
}

TEST(RouteGraph, obeys_one_way_edges_and_takes_the_faster_way_back) {
  const Places places = square();
  const RouteGraph graph(places, 0.6);
  const auto there = graph.over_edges({0.0, 0.0}, Goal{{4.0, 4.0}, 1.5});
  ASSERT_TRUE(there);
  EXPECT_EQ(positions_m(*there), (std::vector<Vec2>{{4.0, 0.0}, {4.0, 4.0}}));
  const auto back = graph.over_edges({4.0, 4.0}, Goal{{0.0, 0.0}, std::nullopt});
  ASSERT_TRUE(back);  // by B it is as long, but slower on the edge from D
  EXPECT_EQ(positions_m(*back), (std::vector<Vec2>{{0.0, 4.0}, {0.0, 0.0}}));
}

TEST(RouteGraph, passes_its_points_on_lines_with_the_limits_of_the_edges) {
  const Places places = square();
  const auto goals = RouteGraph(places, 0.6).over_edges({-0.5, 0.0}, Goal{{4.0, 4.0}, 1.5});
  ASSERT_TRUE(goals);
  ASSERT_EQ(goals->size(), 3u);
  EXPECT_FALSE((*goals)[0].on_line);  // freely to A
  EXPECT_TRUE((*goals)[0].passes);
  EXPECT_TRUE((*goals)[1].on_line);
  EXPECT_FALSE((*goals)[1].max_mps);
  EXPECT_TRUE((*goals)[2].on_line);
  EXPECT_EQ((*goals)[2].max_mps, 0.3);
  EXPECT_EQ((*goals)[2].heading_rad, 1.5);
  EXPECT_FALSE((*goals)[2].passes);
}

TEST(RouteGraph, leaves_the_graph_for_a_goal_beside_it) {
  const Places places = square();
  const auto goals = RouteGraph(places, 0.6).over_edges({0.0, 0.0}, Goal{{5.0, 0.0}, std::nullopt});
  ASSERT_TRUE(goals);
  EXPECT_EQ(positions_m(*goals), (std::vector<Vec2>{{4.0, 0.0}, {5.0, 0.0}}));
  EXPECT_TRUE(goals->front().passes);
  EXPECT_FALSE(goals->back().on_line);
}

TEST(RouteGraph, names_what_no_edges_lead_to) {
  Places places = square();
  places.edges[1] = {.from = "D", .to = "B", .one_way = true, .max_mps = {}};  // nothing leads to D any more
  const RouteGraph graph(places, 0.6);
  EXPECT_EQ(graph.unreachable_from("A"), (std::vector<std::string>{"D", "C"}));
  EXPECT_FALSE(graph.over_edges({0.0, 0.0}, Goal{{4.0, 4.0}, std::nullopt}));
  EXPECT_THROW((void)graph.over_edges({0.0, 0.0}, std::vector{Goal{{4.0, 4.0}, std::nullopt}}), InputError);
  EXPECT_TRUE(graph.over_edges({4.0, 4.0}, Goal{{0.0, 0.0}, std::nullopt}));
}

}  // namespace
}  // namespace lodestar
