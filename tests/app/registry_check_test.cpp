#include "app/registry_check.hpp"

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

TEST(RegistryCheck, reports_the_smallest_hamming_distance_and_its_pairs) {
  const MarkerRegistry registry{.map_from_registry = {},
                                .markers = {at(0b0000, 0, 0), at(0b0111, 1, 0), at(0b1111, 2, 0)}};
  const HammingReport report = hamming_report(registry);
  EXPECT_EQ(report.smallest, 1);
  ASSERT_EQ(report.closest_pairs.size(), 1U);
  EXPECT_EQ(report.closest_pairs.front(), std::pair(0b0111, 0b1111));
}

}  // namespace
}  // namespace lodestar
