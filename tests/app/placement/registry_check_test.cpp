#include "app/placement/registry_check.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

RegisteredMarker at(int id, double x_m, double y_m, double yaw_rad = 0.0) {
  return {.id = id, .position_m = {x_m, y_m, 2.6}, .yaw_rad = yaw_rad, .line = 0};
}

TEST(RegistryCheck, has_nothing_to_say_of_markers_apart) {
  const MarkerRegistry registry{.map_from_registry = {}, .markers = {at(0, 0.0, 0.0), at(7, 1.0, 0.0)}};
  EXPECT_TRUE(check_registry(registry, std::nullopt).empty());
}

TEST(RegistryCheck, tells_touching_squares_from_overlapping_ones) {
  // A printed square is 14 cm wide: 12 cm between the outer dots' centres, and a dot's radius on each side.
  const MarkerRegistry apart{.map_from_registry = {}, .markers = {at(0, 0.0, 0.0), at(7, 0.141, 0.0)}};
  EXPECT_TRUE(check_registry(apart, std::nullopt).empty());
  const MarkerRegistry overlapping{.map_from_registry = {}, .markers = {at(0, 0.0, 0.0), at(7, 0.139, 0.0)}};
  ASSERT_EQ(check_registry(overlapping, std::nullopt).size(), 1U);
  EXPECT_EQ(check_registry(overlapping, std::nullopt).front().kind, IssueKind::overlapping);
}

TEST(RegistryCheck, finds_markers_outside_the_map) {
  OccupancyMap map{.columns = 10,
                   .rows = 10,
                   .resolution_m = 0.1,
                   .map_from_grid = {},
                   .cells = std::vector<std::int8_t>(100, 0)};
  const MarkerRegistry registry{.map_from_registry = {}, .markers = {at(0, 0.5, 0.5), at(7, 5.0, 0.5)}};
  const auto issues = check_registry(registry, map);
  ASSERT_EQ(issues.size(), 1U);
  EXPECT_EQ(issues.front().kind, IssueKind::outside_map);
  EXPECT_EQ(issues.front().ids, std::vector<int>{7});
}

TEST(RegistryCheck, reports_the_smallest_hamming_distance_and_its_pairs_with_the_way_between_them) {
  const MarkerRegistry registry{.map_from_registry = {},
                                .markers = {at(0b0000, 0, 0), at(0b0111, 1, 0), at(0b1111, 4, 4)}};
  const DistanceReport report = upright_distances(registry);
  EXPECT_EQ(report.smallest, 1);
  ASSERT_EQ(report.closest_pairs.size(), 1U);
  EXPECT_EQ(report.closest_pairs.front(), (MarkerPair{0b0111, 0b1111, 5.0}));
}

TEST(RegistryCheck, warns_of_ids_one_dot_apart) {
  const MarkerRegistry registry{.map_from_registry = {}, .markers = {at(447, 0, 0), at(446, 3, 0)}};
  const auto issues = check_registry(registry, std::nullopt);
  ASSERT_EQ(issues.size(), 1U);
  EXPECT_EQ(issues.front().kind, IssueKind::similar_ids);
  EXPECT_FALSE(issues.front().error);
  EXPECT_NE(issues.front().words.find("3.00 m apart"), std::string::npos) << issues.front().words;
}

TEST(RegistryCheck, warns_of_mirror_images_but_not_of_a_marker_that_is_its_own) {
  // 001 is the cell above O, 004 the one to its right; 005 has both.
  const MarkerRegistry pair{.map_from_registry = {}, .markers = {at(1, 0, 0), at(4, 3, 0)}};
  ASSERT_EQ(check_registry(pair, std::nullopt).size(), 1U);
  EXPECT_EQ(check_registry(pair, std::nullopt).front().kind, IssueKind::mirror_images);
  const MarkerRegistry own{.map_from_registry = {}, .markers = {at(5, 0, 0)}};
  EXPECT_TRUE(check_registry(own, std::nullopt).empty());
  EXPECT_EQ(turned_distances(own).smallest, 0);
  EXPECT_EQ(turned_distances(own).closest_pairs.front(), (MarkerPair{5, 5, 0.0}));
}

TEST(RegistryCheck, compares_nothing_in_an_empty_registry) {
  EXPECT_TRUE(upright_distances({}).closest_pairs.empty());
  EXPECT_TRUE(turned_distances({}).closest_pairs.empty());
}

}  // namespace
}  // namespace lodestar
