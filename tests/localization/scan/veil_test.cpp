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
