#include "drivers/simulation/simulated_scanner.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "maps/input_error.hpp"

#include "tests/maps/empty_floor.hpp"

namespace lodestar {
namespace {

using std::chrono::milliseconds;

/// Without noise: what is measured is what is there.
SimulatedScannerOptions perfect() {
  SimulatedScannerOptions options;
  options.beams = 360;
  options.range_sigma_m = 0.0;
  options.spot_rad = 0.0;
  options.invalid_share = 0.0;
  options.wall_reflectivity = 1e6;
  options.disc_reflectivity = 1e6;
  return options;
}

/// 10 m x 10 m with a wall along x from 8.0 to 8.1 m.
OccupancyMap room() {
  OccupancyMap map = empty_floor(100, 100, 0.1);
  for (int row = 0; row < map.rows; ++row) map.cells[map.index({80, row})] = OccupancyMap::occupied;
  return map;
}

Stamp at(int ms) {
  return Stamp(milliseconds(ms));
}

/// Observes every 10 ms up to `until_ms`, with the robot and discs as the two functions say.
template <typename PoseAt>
std::optional<Scan> first_scan(SimulatedScanner& scanner, int until_ms, PoseAt pose_at,
                               const std::vector<DiscState>& discs = {}) {
  for (int ms = 0; ms <= until_ms; ms += 10) scanner.observe(at(ms), pose_at(0.001 * ms), discs);
  return scanner.poll();
}

const auto standing = [](double) { return Pose2{{5.0, 5.0}, 0.0}; };

/// The beam next to an angle.
const Beam& beam_at(const Scan& scan, double angle_rad) {
  return *std::ranges::min_element(
      scan.beams, {}, [&](const Beam& beam) { return std::abs(wrap_angle(beam.angle_rad - angle_rad)); });
}

TEST(SimulatedScanner, delivers_a_turn_when_it_is_over_and_the_delay_too) {
  SimulatedScanner scanner(room(), perfect(), 1);
  EXPECT_FALSE(first_scan(scanner, 120, standing)) << "100 ms of turn and 30 ms of delay";
  scanner.observe(at(130), standing(0.13), {});
  const std::optional<Scan> scan = scanner.poll();
  ASSERT_TRUE(scan);
  ASSERT_EQ(scan->beams.size(), 360U);
  EXPECT_EQ(scan->beams.front().stamp, at(0));
  EXPECT_EQ(scan->beams[180].stamp, at(50));
  EXPECT_DOUBLE_EQ(scan->beams.back().angle_rad, std::numbers::pi);
  EXPECT_EQ(scan->max_range_m, 12.0);
  EXPECT_FALSE(scanner.poll()) << "once only";
}

TEST(SimulatedScanner, measures_walls_and_what_stands_before_them) {
  SimulatedScanner scanner(room(), perfect(), 1);
  const auto scan = first_scan(scanner, 130, standing, {{.radius_m = 0.5, .position_m = {5.0, 7.0}}});
  ASSERT_TRUE(scan);
  EXPECT_NEAR(beam_at(*scan, 0.0).range_m, 3.0, 1e-9);
  EXPECT_NEAR(beam_at(*scan, radians(-45.0)).range_m, 3.0 * std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(beam_at(*scan, radians(90.0)).range_m, 1.5, 1e-9);
  EXPECT_EQ(beam_at(*scan, radians(180.0)).echo, Echo::nothing);
}

TEST(SimulatedScanner, tells_too_near_from_nothing) {
  SimulatedScanner scanner(room(), perfect(), 1);
  const auto at_the_wall = [](double) { return Pose2{{7.97, 5.0}, 0.0}; };
  const auto scan = first_scan(scanner, 130, at_the_wall);
  ASSERT_TRUE(scan);
  EXPECT_EQ(beam_at(*scan, 0.0).echo, Echo::too_near);
  EXPECT_EQ(beam_at(*scan, radians(90.0)).echo, Echo::nothing);
}

TEST(SimulatedScanner, sits_where_its_mount_says) {
  SimulatedScannerOptions options = perfect();
  options.mount.base_from_scanner = {{0.5, 0.0}, radians(90.0)};
  SimulatedScanner scanner(room(), options, 1);
  const auto scan = first_scan(scanner, 130, standing);
  ASSERT_TRUE(scan);
  EXPECT_NEAR(beam_at(*scan, radians(-90.0)).range_m, 2.5, 1e-9);
}

TEST(SimulatedScanner, casts_each_beam_from_where_the_robot_is_at_its_time) {
  SimulatedScanner scanner(room(), perfect(), 1);
  // 1 m/s towards the wall: the beam ahead comes in the middle of the turn, 50 ms after its beginning.
  const auto scan = first_scan(scanner, 130, [](double s) { return Pose2{{5.0 + s, 5.0}, 0.0}; });
  ASSERT_TRUE(scan);
  const Beam& ahead = beam_at(*scan, 0.0);
  EXPECT_NEAR(ahead.range_m, 3.0 - seconds(ahead.stamp), 1e-9);
  EXPECT_NEAR(seconds(ahead.stamp), 0.05, 0.001);

  // Turning at 2 rad/s, it looks at the wall when the two angles cancel.
  SimulatedScanner turning(room(), perfect(), 1);
  const auto turned = first_scan(turning, 130, [](double s) { return Pose2{{5.0, 5.0}, 2.0 * s}; });
  ASSERT_TRUE(turned);
  for (const Beam& beam : turned->beams) {
    if (beam.echo != Echo::hit) continue;
    const double heading_rad = beam.angle_rad + 2.0 * seconds(beam.stamp);
    EXPECT_NEAR(beam.range_m * std::cos(heading_rad), 3.0, 1e-6);
  }
}

TEST(SimulatedScanner, follows_a_disc_within_the_turn) {
  SimulatedScanner scanner(empty_floor(100, 100, 0.1), perfect(), 1);
  for (int ms = 0; ms <= 130; ms += 10) {
    const DiscState disc{.radius_m = 0.5, .position_m = {7.0 + 0.002 * ms, 5.0}, .velocity_mps = {2.0, 0.0}};
    scanner.observe(at(ms), standing(0.0), std::vector{disc});
  }
  const auto scan = scanner.poll();
  ASSERT_TRUE(scan);
  const Beam& ahead = beam_at(*scan, 0.0);
  EXPECT_NEAR(ahead.range_m, 1.5 + 2.0 * seconds(ahead.stamp), 1e-6);
}

TEST(SimulatedScanner, looks_through_glass) {
  SimulatedScannerOptions options = perfect();
  options.glass = {{{7.9, 4.0}, {8.2, 6.0}}};
  SimulatedScanner scanner(room(), options, 1);
  const auto scan = first_scan(scanner, 130, standing);
  ASSERT_TRUE(scan);
  EXPECT_EQ(beam_at(*scan, 0.0).echo, Echo::nothing);
  EXPECT_EQ(beam_at(*scan, radians(45.0)).echo, Echo::hit) << "the wall beside the pane";
}

TEST(SimulatedScanner, scatters_as_its_options_say_and_repeats_by_its_seed) {
  SimulatedScannerOptions options;
  double sum_m2 = 0.0;
  int hits = 0;
  std::vector<double> first;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 1}) {
    SimulatedScanner scanner(room(), options, seed);
    const auto scan = first_scan(scanner, 130, standing);
    ASSERT_TRUE(scan);
    std::vector<double> ranges_m;
    for (const Beam& beam : scan->beams) {
      ranges_m.push_back(beam.range_m);
      if (beam.echo != Echo::hit || std::abs(beam.angle_rad) > 1.0) continue;
      const double error_m = beam.range_m - 3.0 / std::cos(beam.angle_rad);
      sum_m2 += error_m * error_m;
      ++hits;
    }
    if (first.empty()) first = ranges_m;
    EXPECT_EQ(ranges_m == first, seed == 1);
  }
  EXPECT_GT(hits, 1500);
  EXPECT_NEAR(std::sqrt(sum_m2 / hits), 0.01, 0.001);
}

TEST(SimulatedScanner, loses_far_and_grazing_echoes) {
  SimulatedScannerOptions options;
  int near_lost = 0;
  int grazing_lost = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SimulatedScanner scanner(room(), options, seed);
    const auto scan = first_scan(scanner, 130, [](double) { return Pose2{{6.5, 1.0}, 0.0}; });
    ASSERT_TRUE(scan);
    for (const Beam& beam : scan->beams) {
      const bool is_lost = beam.echo == Echo::nothing;
      if (std::abs(beam.angle_rad) < radians(30.0)) near_lost += is_lost ? 1 : 0;
      if (beam.angle_rad > radians(78.0) && beam.angle_rad < radians(80.0)) grazing_lost += is_lost ? 1 : 0;
    }
  }
  EXPECT_EQ(near_lost, 0);
  EXPECT_GT(grazing_lost, 20) << "of 80 beams at 8 m along the wall";
}

TEST(SimulatedScanner, mixes_what_is_before_and_behind_an_edge) {
  SimulatedScannerOptions options;
  options.range_sigma_m = 0.0;
  options.spot_rad = 0.02;
  int mixed = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SimulatedScanner scanner(room(), options, seed);
    const auto at_far = [](double) { return Pose2{{5.0, 5.0}, 0.0}; };
    const auto scan = first_scan(scanner, 130, at_far, {{.radius_m = 0.3, .position_m = {6.5, 5.0}}});
    ASSERT_TRUE(scan);
    for (const Beam& beam : scan->beams) {
      const double angle_rad = std::abs(beam.angle_rad);
      const bool at_edge = angle_rad > radians(9.0) && angle_rad < radians(14.0) && beam.echo == Echo::hit;
      if (at_edge && beam.range_m > 1.7 && beam.range_m < 2.9) ++mixed;
    }
  }
  EXPECT_GT(mixed, 10) << "of 40 edges, most are mixed: the spot is wider than the beams are apart";
}

TEST(SimulatedScanner, refuses_what_is_not_possible) {
  SimulatedScannerOptions options;
  options.beams = 0;
  EXPECT_THROW(SimulatedScanner(room(), options, 1), InputError);
}

}  // namespace
}  // namespace lodestar
