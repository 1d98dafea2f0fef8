#include "localization/scan/veil.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <numbers>

namespace lodestar {
namespace {

/// Rays from the origin, evenly spaced all around, that hit at these ranges.
template <typename Range>
DeskewedScan scan_of(int beams, Range range_m) {
  DeskewedScan scan;
  for (int i = 0; i < beams; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / beams;
    scan.rays.push_back(
        {{}, Vec2::Zero(), range_m(i) * Vec2(std::cos(angle_rad), std::sin(angle_rad)), Echo::hit});
  }
  return scan;
}

std::ptrdiff_t hits(const DeskewedScan& scan) {
  return std::ranges::count(scan.rays, Echo::hit, &Ray::echo);
}

/// A pillar 1 m away before a wall at 4 m, with a mixed pixel beside it at 2.2 m.
double pillar(int i) {
  return i == 100 ? 2.2 : i > 100 && i < 160 ? 1.0 : 4.0;
}

TEST(Veil, is_what_one_beam_alone_hits_beside_an_edge) {
  const DeskewedScan cleared = without_veils(scan_of(720, pillar));
  EXPECT_EQ(cleared.rays[100].echo, Echo::invalid);
  EXPECT_EQ(hits(cleared), 719);
}

/// A gap of a degree between two pillars: one beam meets what is 20 cm behind them, one is a mixed pixel.
TEST(Veil, is_what_two_beams_alone_hit_behind_each_other) {
  const auto gap = [](int i) {
    if (i == 100) return 1.0;
    if (i == 101) return 1.1;
    return i > 60 && i < 140 ? 0.8 : 4.0;
  };
  const DeskewedScan cleared = without_veils(scan_of(720, gap));
  EXPECT_EQ(cleared.rays[100].echo, Echo::invalid);
  EXPECT_EQ(cleared.rays[101].echo, Echo::invalid);
  EXPECT_EQ(hits(cleared), 718);
}

TEST(Veil, is_no_leg_of_a_chair_that_two_beams_hit) {
  const auto pipe = [](int i) { return i == 100 ? 1.5 : i == 101 ? 1.53 : 4.0; };
  EXPECT_EQ(hits(without_veils(scan_of(720, pipe))), 720);
}

/// Of whom the round edge of a leg comes into sight first, from behind a wall.
TEST(Veil, is_nobody_who_steps_out) {
  constexpr double leg_radius_m = 0.06;
  constexpr int wall_ends = 90;
  for (const double range_m : {0.5, 1.0, 2.0}) {
    for (double leg_ends_at = wall_ends + 2.0; leg_ends_at < wall_ends + 6.0; leg_ends_at += 0.1) {
      const auto leg = [&](int i) {
        if (i < wall_ends) return 0.3;
        const double from_edge_m = range_m * 2.0 * std::numbers::pi * (leg_ends_at - i) / 720;
        if (from_edge_m < 0.0) return 11.0;
        const double from_middle_m = std::min(from_edge_m - leg_radius_m, 0.0);
        return range_m - std::sqrt(square(leg_radius_m) - square(from_middle_m));
      };
      EXPECT_EQ(hits(without_veils(scan_of(720, leg))), 720) << range_m << " m, " << leg_ends_at;
    }
  }
}

TEST(Veil, is_no_leg) {
  constexpr double leg_radius_m = 0.06;
  for (const double range_m : {0.5, 1.0, 2.0, 4.0, 8.0}) {
    const double half_rad = std::asin(leg_radius_m / range_m);
    const auto leg = [&](int i) {
      return std::abs(2.0 * std::numbers::pi * (i - 300) / 720) < half_rad ? range_m : 11.0;
    };
    EXPECT_EQ(hits(without_veils(scan_of(720, leg))), 720) << "at " << range_m << " m";
  }
}

TEST(Veil, is_not_told_by_a_scanner_with_few_beams) {
  const auto one_beam = [](int i) { return i == 10 ? 1.0 : 4.0; };
  EXPECT_EQ(hits(without_veils(scan_of(60, one_beam))), 60);
}

}  // namespace
}  // namespace lodestar
