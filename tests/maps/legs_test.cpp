#include "maps/legs.hpp"

#include <gtest/gtest.h>
#include <vector>

#include "tests/maps/disc_scan.hpp"

namespace lodestar {
namespace {

using Disc = testing::ScanDisc;
using testing::scan_of;

/// Two posts of 12 cm are legs, also where one hides the other; a box is not, nor a piece of the wall behind
/// that is seen between two boxes.
TEST(Legs, AreThinThings) {
  Random random(7);
  const auto seen = [&](const std::vector<Disc>& discs) {
    DeskewedScan scan = scan_of({}, 0.0, random);
    for (const Disc& disc : discs) {
      const DeskewedScan other = scan_of({disc}, 0.0, random);
      for (std::size_t i = 0; i < scan.rays.size(); ++i)
        if (other.rays[i].end_m.norm() < scan.rays[i].end_m.norm()) scan.rays[i] = other.rays[i];
    }
    return rays_at_legs(scan).likely.size();
  };
  for (const double x_m : {0.5, 1.0, 1.5, 2.0}) {
    EXPECT_GE(seen({Disc{{x_m, 0.1}, 0.06}, Disc{{x_m, -0.1}, 0.06}}), 6U) << x_m;
    EXPECT_EQ(seen({Disc{{x_m, 0.1}, 0.2}}), 0U) << x_m;
  }
  for (const double x_m : {0.5, 1.0, 1.5})
    EXPECT_GE(seen({Disc{{x_m, 0.0}, 0.06}, Disc{{x_m + 0.2, 0.0}, 0.06}}), 3U) << x_m;
  EXPECT_EQ(seen({Disc{{2.0, 0.0}, 0.3}, Disc{{0.8, 0.45}, 0.4}, Disc{{0.8, -0.45}, 0.4}}), 0U);
}

/// Three posts that touch each other, and the corner of a heap of them, are seen as one or two thin things
/// from most sides: what is seen in one piece is no leg.
TEST(Legs, AreNoPartsOfAThing) {
  Random random(10);
  constexpr double post_m = 0.075;
  int seen_as_legs = 0;
  int asked = 0;
  for (int degrees = 0; degrees < 360; degrees += 5) {
    for (const double range_m : {0.6, 1.0, 1.5, 2.0}) {
      const Pose2 corner{{range_m, 0.0}, radians(degrees)};
      std::vector<Disc> posts;
      for (const Vec2& place : {Vec2(0.0, 0.0), Vec2(2.0 * post_m, 0.0), Vec2(0.0, 2.0 * post_m)})
        posts.push_back({corner * place, post_m});
      ++asked;
      if (!rays_at_legs(scan_of(posts, 0.0, random)).likely.empty()) ++seen_as_legs;
    }
  }
  EXPECT_LT(seen_as_legs, 0.01 * asked) << "of " << asked;
}

/// Of a row that is seen along its side each post shows a sliver beside the one before it.
TEST(Legs, AreNoEndsOfARow) {
  Random random(11);
  int seen_as_legs = 0;
  int asked = 0;
  for (double from_side_m = 0.06; from_side_m < 0.2; from_side_m += 0.01) {
    for (double from_end_m = 0.35; from_end_m < 1.0; from_end_m += 0.05) {
      constexpr double post_m = 0.08;
      std::vector<Disc> row;
      for (int i = 0; i < 12; ++i)
        row.push_back({{from_end_m + (2.0 * i + 1.0) * post_m, -from_side_m - post_m}, post_m});
      ++asked;
      if (!rays_at_legs(scan_of(row, 0.0, random)).likely.empty()) ++seen_as_legs;
    }
  }
  EXPECT_LT(seen_as_legs, 0.05 * asked) << "of " << asked;
}

/// Beside a leg up to 3 cm are seen of the other, which it hides.
TEST(Legs, MayShowASliverOfEachOther) {
  Random random(12);
  int seen_as_legs = 0;
  int asked = 0;
  for (double range_m = 0.5; range_m < 1.5; range_m += 0.05) {
    for (double sliver_m = 0.0; sliver_m < 0.025; sliver_m += 0.005) {
      const std::vector<Disc> legs{{{range_m, 0.0}, 0.06},
                                   {{range_m + 0.2, sliver_m * (range_m + 0.2) / range_m}, 0.06}};
      ++asked;
      if (!rays_at_legs(scan_of(legs, 0.0, random)).likely.empty()) ++seen_as_legs;
    }
  }
  EXPECT_GT(seen_as_legs, 0.9 * asked) << "of " << asked;
}

}  // namespace
}  // namespace lodestar
