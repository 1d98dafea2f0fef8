#include "planning/place_screen.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "maps/random.hpp"

namespace lodestar {
namespace {

struct From {
  Vec2 position = Vec2::Zero();
  double way_before_cells = 0.0;
};

bool is_short(const From& from, const Vec2& here, double longest_cells) {
  return from.way_before_cells + (here - from.position).norm() <= longest_cells;
}

/// As by its definition: the path turns towards the corner, and the corner is not beyond its legs.
bool is_taut(const From& from, const Vec2& here, const TurnAround& turn) {
  const Vec2 arrival = here - from.position;
  const double side = cross(arrival, turn.way);
  return side * cross(arrival, turn.to_corner) >= 0.0 && side * cross(turn.way, turn.to_corner) >= 0.0;
}

std::vector<From> random_places(Random& random, PlaceScreen& screen) {
  std::vector<From> places(50);
  for (From& place : places) {
    place.position = {random.uniform(0.0, 4000.0), random.uniform(0.0, 4000.0)};
    place.way_before_cells = random.uniform(0.0, 3000.0);
    screen.add(place.position, place.way_before_cells);
  }
  return places;
}

bool has(std::span<const std::uint32_t> some, std::uint32_t place) {
  return std::ranges::find(some, place) != some.end();
}

TEST(PlaceScreen, leaves_out_no_place_that_passes_the_exact_tests_and_hardly_keeps_another) {
  Random random(3);
  int good = 0;
  int bad = 0;
  int kept_bad = 0;
  for (int trial = 0; trial < 200; ++trial) {
    PlaceScreen screen;
    const std::vector<From> places = random_places(random, screen);
    const Vec2 here{random.uniform(0.0, 4000.0), random.uniform(0.0, 4000.0)};
    const TurnAround turn{.way = {random.uniform(-300.0, 300.0), random.uniform(-300.0, 300.0)},
                          .to_corner = {random.uniform(-4.0, 4.0), random.uniform(-4.0, 4.0)}};
    const double longest_cells = random.uniform(500.0, 6000.0);
    const auto kept = screen.may_lead_to(here, turn, longest_cells);
    for (std::uint32_t i = 0; i < places.size(); ++i) {
      const bool is_good = is_short(places[i], here, longest_cells) && is_taut(places[i], here, turn);
      if (is_good) {
        ++good;
        EXPECT_TRUE(has(kept, i)) << places[i].position.transpose();
      } else {
        ++bad;
        if (has(kept, i)) ++kept_bad;
      }
    }
  }
  EXPECT_GT(good, 500);
  EXPECT_LT(kept_bad, bad / 1000 + 1);
}

TEST(PlaceScreen, keeps_an_arrival_straight_on_whichever_side_the_corner_is) {
  for (const double side : {3.0, -3.0}) {
    PlaceScreen screen;
    screen.add({1000.0 / 3.0, 2000.0 / 7.0}, 0.0);
    const Vec2 way = Vec2(2.0, 1.0).normalized() * 700.0 / 3.0;
    const Vec2 here = Vec2(1000.0 / 3.0, 2000.0 / 7.0) + way;
    const TurnAround turn{.way = way, .to_corner = side * Vec2(-way.y(), way.x()).normalized()};
    EXPECT_EQ(screen.may_lead_to(here, turn, 1000.0).size(), 1U);
  }
}

TEST(PlaceScreen, lets_all_within_reach_pass_where_there_is_no_corner_or_it_is_in_line) {
  PlaceScreen screen;
  for (int i = 0; i < 8; ++i) screen.add(100.0 * Vec2(std::cos(i), std::sin(i)), 0.0);
  screen.add({300.0, 0.0}, 0.0);
  EXPECT_EQ(screen.may_lead_to(Vec2::Zero(), std::nullopt, 200.0).size(), 8U);
  const TurnAround in_line{.way = {2.0, 2.0}, .to_corner = {1.0, 1.0}};
  EXPECT_EQ(screen.may_lead_to(Vec2::Zero(), in_line, 200.0).size(), 8U);
}

TEST(PlaceScreen, keeps_none_that_was_removed_and_begins_anew_when_cleared) {
  PlaceScreen screen;
  screen.add({1.0, 0.0}, 0.0);
  screen.add({2.0, 0.0}, 0.0);
  screen.remove(0);
  const auto kept = screen.may_lead_to(Vec2::Zero(), std::nullopt, 1e9);
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0], 1U);
  screen.clear();
  EXPECT_TRUE(screen.may_lead_to(Vec2::Zero(), std::nullopt, 1e9).empty());
}

}  // namespace
}  // namespace lodestar
