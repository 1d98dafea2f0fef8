#include "app/placement/places_check.hpp"

#include <gmock/gmock.h>

namespace lodestar {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// The lab: free at (2.5, 5), a cupboard at (3.3, 6.2), 15.3 x 7.5 m.
Site lab() {
  return load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
}

std::vector<std::string> words_of(const std::vector<PlacesIssue>& issues) {
  std::vector<std::string> words;
  for (const PlacesIssue& issue : issues)
    words.push_back(std::string(to_string(issue.kind)) + ": " + issue.words);
  return words;
}

Polygon around(const Vec2& middle_m, double half_m) {
  return {middle_m + Vec2(-half_m, -half_m), middle_m + Vec2(half_m, -half_m),
          middle_m + Vec2(half_m, half_m), middle_m + Vec2(-half_m, half_m)};
}

TEST(PlacesCheck, finds_nothing_wrong_with_the_lab) {
  Site site = lab();
  EXPECT_THAT(words_of(check_places(site)), IsEmpty());
  site.places.places = {{"desk", {2.5, 5.0}, radians(90.0)}};
  EXPECT_THAT(words_of(check_places(site)), IsEmpty());
}

TEST(PlacesCheck, names_places_in_obstacles_and_in_keep_outs) {
  Site site = lab();
  site.places.places = {{"cupboard", {3.3, 6.2}, std::nullopt},
                        {"far", {99.0, 1.0}, std::nullopt},
                        {"desk", {2.5, 5.0}, std::nullopt}};
  site.places.keep_out = {{"elsewhere", around({9.0, 2.0}, 0.05)}, {"", around({2.5, 5.3}, 0.1)}};
  EXPECT_THAT(words_of(check_places(site)),
              ElementsAre("in-obstacle: 'cupboard' stands in an obstacle or beside the map",
                          "in-obstacle: 'far' stands in an obstacle or beside the map",
                          "in-keep-out: 'desk' stands in keep-out 2"));
}

TEST(PlacesCheck, names_what_the_others_cannot_reach) {
  Site site = lab();
  site.places.places = {{"west", {1.7, 5.6}, std::nullopt}, {"east", {13.5, 2.0}, std::nullopt}};
  ASSERT_THAT(words_of(check_places(site)), IsEmpty());
  site.places.keep_out = {{"wall", {{7.0, -1.0}, {7.2, -1.0}, {7.2, 9.0}, {7.0, 9.0}}}};
  EXPECT_THAT(words_of(check_places(site)),
              ElementsAre("unreachable: goal 1 of site.yaml cannot be reached from the start",
                          "unreachable: 'east' cannot be reached from the start"));
}

TEST(PlacesCheck, names_edges_that_are_no_straight_way) {
  Site site = lab();
  site.places.places = {{"desk", {2.5, 5.0}, std::nullopt}};
  site.places.nodes = {{"N1", {1.7, 5.0}}, {"N2", {13.5, 2.0}}, {"N3", {2.5, 4.6}}};
  site.places.edges = {{.from = "N1", .to = "desk", .max_mps = {}},
                       {.from = "desk", .to = "N2", .max_mps = {}}};
  EXPECT_THAT(words_of(check_places(site)),
              ElementsAre("blocked-edge: the edge from 'desk' to 'N2' is blocked by an obstacle",
                          "lonely-node: no edge leads to the node 'N3'"));
  site.places.edges.pop_back();
  site.places.nodes.resize(1);
  site.places.keep_out = {{"hole", around({2.1, 5.0}, 0.05)}};
  EXPECT_THAT(words_of(check_places(site)),
              ElementsAre("blocked-edge: the edge from 'N1' to 'desk' is blocked by a keep-out"));
}

/// Without the markers of its eastern half.
Site half_bare_lab() {
  Site site = lab();
  std::erase_if(site.registry.markers, [&](const RegisteredMarker& marker) {
    return map_from_marker(site.registry, marker).translation().x() > 7.0;
  });
  return site;
}

TEST(PlacesCheck, warns_of_missions_and_edges_that_see_no_marker) {
  Site site = half_bare_lab();
  site.places.places = {{"west", {1.7, 5.6}, std::nullopt}, {"east", {13.5, 2.0}, std::nullopt}};
  site.places.missions = {{.name = "there", .stops = {{"west"}, {"east"}}}};
  const std::vector<PlacesIssue> one_way = check_places(site);
  ASSERT_FALSE(one_way.empty());
  const PlacesIssue& last = one_way.back();
  EXPECT_THAT(words_of(one_way).back(), HasSubstr("blind-mission: mission 'there' sees no marker for 7."));
  EXPECT_FALSE(last.error);
  ASSERT_EQ(last.positions_m.size(), 2U);
  EXPECT_GT(last.positions_m[0].x(), 6.0);
  EXPECT_LT((last.positions_m[1] - Vec2(13.5, 2.0)).norm(), 0.1) << "to its end";
  site.places.missions[0].repeat = 2;
  EXPECT_EQ(check_places(site).size(), 2U * one_way.size()) << "and the way back to begin again";

  site.places.missions.clear();
  site.places.nodes = {{"N1", {9.4, 3.5}}, {"N2", {13.0, 3.5}}};
  site.places.places.clear();
  site.places.edges = {{.from = "N1", .to = "N2", .max_mps = {}}};
  EXPECT_THAT(words_of(check_places(site)),
              ElementsAre("blind-edge: the edge from 'N1' to 'N2' sees no marker for 3.6 m from 9.4, 3.5 m"));
  site.registry = lab().registry;
  EXPECT_THAT(words_of(check_places(site)), Not(Contains(HasSubstr("3.6 m"))));
}

TEST(PlacesCheck, warns_of_zones_that_were_drawn_for_another_map) {
  Site site = lab();
  site.places.keep_out = {{"stairs", around({40.0, 5.0}, 1.0)}};
  site.places.speed_zones = {{"ward", around({5.0, 5.0}, 1.0), 0.2}, {"", around({-5.0, 5.0}, 1.0), 0.2}};
  const std::vector<PlacesIssue> issues = check_places(site);
  EXPECT_THAT(words_of(issues), ElementsAre("zone-off-map: keep-out 'stairs' does not touch the map",
                                            "zone-off-map: speed zone 2 does not touch the map"));
  EXPECT_FALSE(issues.front().error);
  EXPECT_EQ(issue_json(issues.front())["severity"], "warning");
}

TEST(PlacesCheck, minds_the_heading_of_a_robot_that_is_no_disc) {
  Site site = lab();
  // 1.2 m long, 0.4 m wide; between the keep-outs a lane of 0.6 m along x.
  site.robot.footprint = Footprint({{-0.6, -0.2}, {0.6, -0.2}, {0.6, 0.2}, {-0.6, 0.2}});
  site.places.keep_out = {{"south", {{1.9, 3.9}, {3.1, 3.9}, {3.1, 4.7}, {1.9, 4.7}}},
                          {"north", {{1.9, 5.3}, {3.1, 5.3}, {3.1, 5.8}, {1.9, 5.8}}}};
  site.places.places = {{"along", {2.5, 5.0}, 0.0}, {"across", {2.5, 5.0}, radians(90.0)}};
  EXPECT_THAT(words_of(check_places(site)), testing::Contains(HasSubstr("'across' stands in keep-out")));
  EXPECT_THAT(words_of(check_places(site)), testing::Not(testing::Contains(HasSubstr("'along' stands"))));
}

}  // namespace
}  // namespace lodestar
