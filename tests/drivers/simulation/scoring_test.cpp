#include "drivers/simulation/scoring.hpp"

#include <gtest/gtest.h>

#include "drivers/simulation/disc_contact.hpp"
#include "maps/random.hpp"

#include "tests/maps/empty_floor.hpp"

namespace lodestar {
namespace {

// A hand-made map of 8 x 6 cells of 0.5 m, drawn with row 0 at the bottom:
//
//   3 m  . . . . . . . .
//        . . . . . . . .
//        . . . . # . . .      # occupied, x 2.0..2.5 m, y 1.5..2.0 m
//        . ? . . . . . .      ? unknown,  x 0.5..1.0 m, y 1.0..1.5 m
//        . . . . . . . .
//        . . . . . . . .
//   0 m                4 m
OccupancyMap hand_made_map() {
  OccupancyMap map = empty_floor(8, 6, 0.5);
  map.cells[map.index({4, 3})] = OccupancyMap::occupied;
  map.cells[map.index({1, 2})] = OccupancyMap::unknown;
  return map;
}

constexpr double radius_m = 0.25;

Stamp at(int step) {
  return Stamp(std::chrono::milliseconds(20 * step));
}

TEST(DiscContact, touching_an_edge_is_no_contact) {
  const OccupancyMap map = hand_made_map();
  EXPECT_FALSE(disc_overlaps_obstacle(map, {1.75, 1.75}, radius_m)) << "touches the square from the left";
  EXPECT_TRUE(disc_overlaps_obstacle(map, {1.76, 1.75}, radius_m));
  EXPECT_FALSE(disc_overlaps_obstacle(map, {2.25, 2.25}, radius_m)) << "touches it from above";
  EXPECT_TRUE(disc_overlaps_obstacle(map, {2.25, 2.24}, radius_m));
  EXPECT_FALSE(disc_overlaps_obstacle(map, {0.25, 0.25}, radius_m)) << "touches two edges of the map";
}

TEST(DiscContact, measures_to_the_corner_of_a_square_and_not_to_its_bounding_circle) {
  const OccupancyMap map = hand_made_map();
  // A 3-4-5 triangle away from the corner (2.0, 1.5).
  EXPECT_FALSE(disc_overlaps_obstacle(map, {2.0 - 0.15, 1.5 - 0.20}, radius_m));
  EXPECT_TRUE(disc_overlaps_obstacle(map, {2.0 - 0.149, 1.5 - 0.20}, radius_m));
}

TEST(DiscContact, unknown_and_outside_are_obstacles) {
  const OccupancyMap map = hand_made_map();
  EXPECT_TRUE(disc_overlaps_obstacle(map, {0.75, 1.25}, radius_m));
  EXPECT_TRUE(disc_overlaps_obstacle(map, {0.24, 0.25}, radius_m));
  EXPECT_TRUE(disc_overlaps_obstacle(map, {3.76, 2.5}, radius_m));
  EXPECT_TRUE(disc_overlaps_obstacle(map, {1e300, 2.5}, radius_m));
  EXPECT_TRUE(disc_overlaps_obstacle(map, {std::nan(""), 2.5}, radius_m));
  EXPECT_TRUE(disc_overlaps_obstacle(map, {2.0, 2.5}, 100.0));
  EXPECT_TRUE(disc_overlaps_obstacle(OccupancyMap{}, {0.0, 0.0}, radius_m))
      << "an empty map has no free cell";
}

TEST(DiscContact, agrees_with_points_sampled_in_the_disc_on_a_rotated_map) {
  OccupancyMap map = hand_made_map();
  map.map_from_grid = {{-3.0, 7.0}, radians(33.0)};
  Random random(5);
  for (int trial = 0; trial < 500; ++trial) {
    const Vec2 centre = map.map_from_grid * Vec2(random.uniform(-0.2, 4.2), random.uniform(-0.2, 3.2));
    bool sampled = false;
    for (int sample = 0; sample < 400; ++sample) {
      const double reach_m = radius_m * std::sqrt(random.uniform());
      const double angle_rad = random.uniform(0.0, 2.0 * std::numbers::pi);
      const Cell cell = map.cell_at(centre + reach_m * Vec2(std::cos(angle_rad), std::sin(angle_rad)));
      sampled = sampled || !map.contains(cell) || !is_drivable(map.at(cell));
    }
    const bool overlaps = disc_overlaps_obstacle(map, centre, radius_m);
    EXPECT_TRUE(overlaps || !sampled) << "a point of the disc lies in an obstacle, trial " << trial;
    // Overlaps that so many samples miss are near the rim.
    EXPECT_TRUE(sampled || !disc_overlaps_obstacle(map, centre, 0.75 * radius_m)) << "trial " << trial;
  }
}

TEST(Scorer, counts_a_contact_once_from_touch_to_release) {
  Scorer scorer(hand_made_map(), radius_m);
  scorer.record({at(0), {{1.5, 1.75}, 0.0}});
  scorer.record({at(1), {{1.75, 1.75}, 0.0}});
  EXPECT_EQ(scorer.contacts(), 0);
  scorer.record({at(2), {{1.8, 1.75}, 0.0}});
  scorer.record({at(3), {{1.9, 1.75}, 0.0}});
  scorer.record({at(4), {{1.5, 1.75}, 0.0}}, true);  // blocked by an obstacle
  EXPECT_EQ(scorer.contacts(), 1);
  scorer.record({at(5), {{1.5, 1.75}, 0.0}});
  scorer.record({at(6), {{1.8, 1.75}, 0.0}});
  EXPECT_EQ(scorer.contacts(), 2);
  EXPECT_EQ(scorer.track().size(), 7U);
}

TEST(Scorer, counts_a_contact_that_lasts_in_the_drive_in_which_it_began) {
  Scorer scorer(hand_made_map(), radius_m);
  scorer.record({at(0), {{1.8, 1.75}, 0.0}});
  EXPECT_EQ(scorer.contacts(), 1);
  scorer.forget();
  scorer.record({at(1), {{1.8, 1.75}, 0.0}});
  EXPECT_EQ(scorer.contacts(), 0);
}

TEST(Scorer, scores_an_arrival_by_the_truth_at_that_moment) {
  Scorer scorer(hand_made_map(), radius_m);
  scorer.record({at(0), {{0.0, 0.0}, 0.0}});
  scorer.record({at(1), {{1.03, 2.04}, radians(-179.0)}});
  scorer.claim_arrival({1.0, 2.0}, radians(179.0));
  scorer.record({at(2), {{3.0, 3.0}, 0.0}});
  scorer.claim_arrival({3.0, 2.5}, std::nullopt);
  ASSERT_EQ(scorer.arrivals().size(), 2U);
  EXPECT_NEAR(scorer.arrivals()[0].position_error_m, 0.05, 1e-12);
  EXPECT_NEAR(*scorer.arrivals()[0].heading_error_rad, radians(2.0), 1e-12);
  EXPECT_NEAR(scorer.arrivals()[1].position_error_m, 0.5, 1e-12);
  EXPECT_FALSE(scorer.arrivals()[1].heading_error_rad);
}

TEST(Scorer, cannot_score_an_arrival_before_the_first_truth) {
  Scorer scorer(hand_made_map(), radius_m);
  scorer.claim_arrival({1.0, 2.0}, std::nullopt);
  EXPECT_TRUE(scorer.arrivals().empty());
}

TEST(Scorer, measures_distance_from_the_path_only_while_it_is_driven) {
  Scorer scorer(hand_made_map(), radius_m);
  scorer.record({at(0), {{1.0, 0.5}, 0.0}});
  scorer.record({at(1), {{1.1, 0.5}, 0.0}});
  EXPECT_TRUE(scorer.path_distances_m().empty()) << "no path yet";
  scorer.claim_path({{{1.0, 0.5}, {3.0, 0.5}}});
  scorer.record({at(2), {{1.1, 0.5}, 0.5}});
  EXPECT_TRUE(scorer.path_distances_m().empty()) << "turning on the spot";
  scorer.record({at(3), {{1.2, 0.53}, 0.0}});
  scorer.record({at(4), {{3.04, 0.5}, 0.0}});
  scorer.claim_arrival({3.0, 0.5}, std::nullopt);
  scorer.record({at(5), {{3.2, 0.5}, 0.0}});
  ASSERT_EQ(scorer.path_distances_m().size(), 2U);
  EXPECT_NEAR(scorer.path_distances_m()[0], 0.03, 1e-12);
  EXPECT_NEAR(scorer.path_distances_m()[1], 0.04, 1e-12);
}

TEST(Scorer, follows_no_path_when_the_path_is_empty) {
  Scorer scorer(hand_made_map(), radius_m);
  scorer.claim_path({{{1.0, 0.5}, {3.0, 0.5}}});
  scorer.claim_path({});
  scorer.record({at(0), {{1.0, 0.5}, 0.0}});
  scorer.record({at(1), {{2.0, 0.5}, 0.0}});
  EXPECT_TRUE(scorer.path_distances_m().empty());
}

TEST(Percentile, is_the_nearest_rank) {
  EXPECT_FALSE(percentile({}, 0.5));
  EXPECT_EQ(percentile({3.0}, 0.0), 3.0);
  EXPECT_EQ(percentile({3.0, 1.0, 2.0}, 0.5), 2.0);
  std::vector<double> hundred;
  for (int i = 100; i > 0; --i) hundred.push_back(i);
  EXPECT_EQ(percentile(hundred, 0.95), 95.0);
  EXPECT_EQ(percentile(hundred, 0.951), 96.0);
  EXPECT_EQ(percentile(hundred, 1.0), 100.0);
  EXPECT_EQ(percentile(hundred, 7.0), 100.0);
}

TEST(Scorer, counts_contacts_of_the_footprint_and_not_of_the_disc) {
  // 1 m long and 0.2 m wide, in a disc of 0.25 m only by name.
  const Footprint plank({{-0.5, -0.1}, {0.5, -0.1}, {0.5, 0.1}, {-0.5, 0.1}});
  const auto contacts = [&](const Pose2& pose, std::optional<Footprint> footprint) {
    Scorer scorer(hand_made_map(), radius_m, std::move(footprint));
    scorer.record({at(0), pose});
    return scorer.contacts();
  };
  const Pose2 ends_in_the_obstacle{{1.6, 1.75}, 0.0};
  EXPECT_EQ(contacts(ends_in_the_obstacle, plank), 1);
  EXPECT_EQ(contacts(ends_in_the_obstacle, std::nullopt), 0);
  const Pose2 passes_beside_it{{1.85, 1.75}, radians(90.0)};
  EXPECT_EQ(contacts(passes_beside_it, plank), 0);
  EXPECT_EQ(contacts(passes_beside_it, std::nullopt), 1);
}

}  // namespace
}  // namespace lodestar
