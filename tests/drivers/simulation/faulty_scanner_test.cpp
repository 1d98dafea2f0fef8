#include "drivers/simulation/faulty_scanner.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "tests/maps/empty_floor.hpp"

// Each fault of the scanner by itself: what the robot's driver gets of it.
namespace lodestar {
namespace {

using std::chrono::milliseconds;

struct Delivery {
  Scan scan;
  Stamp arrival;
};

/// 10 m x 10 m with a wall along x from 8.0 to 8.1 m; the robot stands 3 m before it.
OccupancyMap room() {
  OccupancyMap map = empty_floor(100, 100, 0.1);
  for (int row = 0; row < map.rows; ++row) map.cells[map.index({80, row})] = OccupancyMap::occupied;
  return map;
}

SimulatedScannerOptions options(double noise_m) {
  SimulatedScannerOptions options;
  options.beams = 360;
  options.range_sigma_m = noise_m;
  options.wall_reflectivity = 1e6;
  options.invalid_share = 0.0;
  return options;
}

/// A scanner for two seconds, with a fault from 0.5 s on.
class TwoSeconds {
 public:
  explicit TwoSeconds(const std::optional<Fault>& fault, std::uint64_t seed = 1, double noise_m = 0.01)
      : scanner_(room(), options(noise_m), 1), faulty_(scanner_, seed) {
    for (Stamp now{}; now <= Stamp(std::chrono::seconds(2)); now += milliseconds(10)) {
      faulty_.advance(now);
      if (now == begin && fault) faulty_.suffer({*fault});
      scanner_.observe(now, Pose2{{5.0, 5.0}, 0.0}, {});
      while (std::optional<Scan> scan = faulty_.poll()) deliveries.push_back({std::move(*scan), now});
    }
  }

  static constexpr Stamp begin{milliseconds(500)};
  std::vector<Delivery> deliveries;

  /// The newest, of what the fault has befallen.
  [[nodiscard]] const Scan& last() const { return deliveries.back().scan; }
  [[nodiscard]] ScanPackets packets() const { return faulty_.packets(); }

 private:
  SimulatedScanner scanner_;
  FaultyScanner faulty_;
};

std::ptrdiff_t count(const Scan& scan, Echo echo) {
  return std::ranges::count(scan.beams, echo, &Beam::echo);
}

bool are_equal(const Scan& one, const Scan& other) {
  return std::ranges::equal(one.beams, other.beams, [](const Beam& a, const Beam& b) {
    return a.echo == b.echo && a.range_m == b.range_m && a.angle_rad == b.angle_rad;
  });
}

TEST(FaultyScanner, changes_nothing_without_a_fault_or_by_those_of_others) {
  const TwoSeconds healthy(std::nullopt);
  const TwoSeconds other(Fault{.kind = FaultKind::camera_black});
  ASSERT_EQ(healthy.deliveries.size(), 19U) << "the last turn that has been delivered ended at 1.9 s";
  ASSERT_EQ(other.deliveries.size(), 19U);
  EXPECT_EQ(healthy.deliveries.front().arrival, Stamp(milliseconds(130)));
  for (std::size_t i = 0; i < 19; ++i)
    EXPECT_TRUE(are_equal(healthy.deliveries[i].scan, other.deliveries[i].scan)) << i;
  EXPECT_EQ(healthy.packets().read, 19U * 30U);
  EXPECT_EQ(healthy.packets().refused, 0U);
}

TEST(FaultyScanner, falls_silent) {
  const TwoSeconds silent(Fault{.kind = FaultKind::scanner_silent});
  ASSERT_FALSE(silent.deliveries.empty());
  EXPECT_LT(silent.deliveries.back().arrival, TwoSeconds::begin);
  EXPECT_EQ(silent.packets().read, silent.deliveries.size() * 30U) << "a silent line brings no packets";
}

TEST(FaultyScanner, repeats_the_last_scan_with_new_stamps) {
  const TwoSeconds frozen(Fault{.kind = FaultKind::scanner_frozen});
  ASSERT_EQ(frozen.deliveries.size(), 19U);
  const auto first = std::ranges::find_if(
      frozen.deliveries, [](const Delivery& delivery) { return delivery.arrival >= TwoSeconds::begin; });
  for (auto delivery = first; delivery != frozen.deliveries.end(); ++delivery) {
    EXPECT_TRUE(are_equal(delivery->scan, std::prev(first)->scan));
    EXPECT_EQ(delivery->scan.beams.front().stamp,
              std::prev(delivery)->scan.beams.front().stamp + milliseconds(100));
  }
  EXPECT_FALSE(are_equal(frozen.deliveries[0].scan, frozen.deliveries[1].scan)) << "noise";
}

TEST(FaultyScanner, loses_beams) {
  const TwoSeconds dropped(Fault{.kind = FaultKind::scanner_beams_dropped, .share = 0.5});
  EXPECT_EQ(count(dropped.deliveries.front().scan, Echo::invalid), 0);
  EXPECT_NEAR(static_cast<double>(count(dropped.last(), Echo::invalid)), 180.0, 40.0);
}

TEST(FaultyScanner, gets_dirty_in_a_sector) {
  const TwoSeconds dirty(Fault{.kind = FaultKind::scanner_dirty,
                               .direction_rad = radians(30.0),
                               .share = 0.5,
                               .width_rad = radians(20.0)});
  for (const Beam& beam : dirty.last().beams) {
    const bool is_soiled = beam.echo == Echo::invalid || beam.echo == Echo::too_near;
    EXPECT_EQ(is_soiled, std::abs(beam.angle_rad - radians(30.0)) <= radians(10.0)) << beam.angle_rad;
  }
  EXPECT_GT(count(dirty.last(), Echo::too_near), 3);
  EXPECT_GT(count(dirty.last(), Echo::invalid), 3);
}

TEST(FaultyScanner, delivers_late) {
  const TwoSeconds late(Fault{.kind = FaultKind::scanner_late, .delay_s = 0.25});
  const Delivery& last = late.deliveries.back();
  EXPECT_EQ(last.arrival - last.scan.beams.front().stamp, milliseconds(130 + 250));
}

TEST(FaultyScanner, has_a_clock_that_jumps_and_drifts) {
  const TwoSeconds drifting(Fault{.kind = FaultKind::scanner_clock, .delay_s = -0.02, .drift_s_per_s = 0.05});
  const TwoSeconds healthy(std::nullopt);
  const Stamp right = healthy.last().beams.front().stamp;
  const double off_s = seconds(drifting.last().beams.front().stamp - right);
  EXPECT_NEAR(off_s, -0.02 + 0.05 * seconds(right - TwoSeconds::begin), 1e-6);
}

// The robot stands: a slower turn has the same ranges, and longer between its beams.
TEST(FaultyScanner, turns_slowly) {
  const TwoSeconds slow(Fault{.kind = FaultKind::scanner_motor, .share = 0.5});
  const Scan& last = slow.last();
  EXPECT_NEAR(seconds(last.beams.back().stamp - last.beams.front().stamp), 0.2 * 359 / 360, 1e-6);
  const Scan& before = slow.deliveries[slow.deliveries.size() - 2].scan;
  EXPECT_EQ(last.beams.front().stamp - before.beams.front().stamp, milliseconds(200));
  EXPECT_EQ(slow.deliveries.back().arrival - last.beams.front().stamp, milliseconds(230));
}

// The nearest point of the wall ahead is seen as far to the right as the scanner is turned to the left.
TEST(FaultyScanner, is_turned_on_its_mount) {
  const TwoSeconds turned(Fault{.kind = FaultKind::scanner_turned, .turn_rad = radians(5.0)}, 1, 0.0);
  const auto nearest_deg = [](const Scan& scan) {
    double sum_deg = 0.0;
    int hits = 0;
    for (const Beam& beam : scan.beams) {
      if (beam.echo != Echo::hit || beam.range_m > 3.05) continue;
      sum_deg += degrees(beam.angle_rad);
      ++hits;
    }
    return sum_deg / hits;
  };
  EXPECT_NEAR(nearest_deg(turned.deliveries.front().scan), 0.0, 0.1);
  EXPECT_NEAR(nearest_deg(turned.last()), -5.0, 0.1);
}

TEST(FaultyScanner, refuses_packets_and_counts_them) {
  const Fault fault{.kind = FaultKind::scanner_packets_lost, .share = 0.3};
  const TwoSeconds lossy(fault);
  const ScanPackets packets = lossy.packets();
  EXPECT_EQ(packets.read + packets.refused, 19U * 30U);
  std::size_t missing = 0;
  for (const Delivery& delivery : lossy.deliveries) missing += 360U - delivery.scan.beams.size();
  EXPECT_EQ(missing, 12U * packets.refused);
  EXPECT_NEAR(static_cast<double>(packets.refused), 0.3 * 15 * 30, 40.0);
  EXPECT_TRUE(are_equal(lossy.last(), TwoSeconds(fault).last())) << "the same with the same seed";
  EXPECT_FALSE(are_equal(lossy.last(), TwoSeconds(fault, 2).last()));
}

}  // namespace
}  // namespace lodestar
