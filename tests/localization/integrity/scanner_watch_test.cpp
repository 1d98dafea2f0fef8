#include "localization/integrity/scanner_watch.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/maps/cast_scan.hpp"

namespace lodestar {
namespace {

using std::chrono::milliseconds;

constexpr Duration period = milliseconds(100);
constexpr double track_m = 0.4;

/// A robot that drives about in a room with two cupboards, people who walk by, and a scanner with range
/// noise, mixed pixels and lost beams.
class Drive {
 public:
  explicit Drive(std::uint64_t seed, int beams = 180) : random_(seed), beams_(beams) {}

  /// Drives and measures for one turn of the scanner; `turned_rad` is the error of the mount.
  Scan turn(ScannerWatch& watch, double turned_rad = 0.0) {
    const Pose2 before = pose;
    drive();
    const Stamp begin = now;
    const auto at = [&](Stamp stamp) {
      const double share = seconds(stamp - begin) / seconds(period);
      return Pose2{before.position_m + share * (pose.position_m - before.position_m),
                   before.yaw_rad + share * wrap_angle(pose.yaw_rad - before.yaw_rad) + turned_rad};
    };
    std::vector<testing::Disc> people;
    for (const double way : {0.9, 1.4})
      people.push_back(
          {{4.0 + 3.0 * std::sin(way * seconds(now) / 3.0), 2.0 + way * std::cos(seconds(now) / 4.0)}, 0.15});
    Scan scan = testing::cast_scan(room_, people, begin, at, random_, {.beams = beams_});
    for (Beam& beam : scan.beams) {
      if (random_.uniform() < 0.02) beam.range_m *= random_.uniform(0.3, 1.0);  // a mixed pixel
      if (random_.uniform() < 0.03) beam.echo = Echo::invalid;
    }
    now += period;
    travel_.stamp = now;
    watch.add_travel(travel_);
    std::vector<Pose2> believed;
    const Vec2 error = 0.005 * Vec2(random_.normal(), random_.normal());
    const double yaw_error_rad = radians(0.1) * random_.normal();
    for (const Beam& beam : scan.beams) {
      const Pose2 exact = at(beam.stamp);
      believed.push_back({exact.position_m + error, exact.yaw_rad - turned_rad + yaw_error_rad});
    }
    watch.add_trusted(scan, believed, field_);
    return scan;
  }

  /// So many healthy scans.
  void warm_up(ScannerWatch& watch, int scans = 50) {
    for (int i = 0; i < scans; ++i) {
      const Scan scan = turn(watch);
      watch.update(scan, arrival());
      ASSERT_FALSE(watch.fault(arrival()));
    }
  }

  [[nodiscard]] Stamp arrival() const { return now + milliseconds(30); }

  Stamp now{std::chrono::hours(1)};
  Pose2 pose{{1.5, 1.5}, 0.4};
  bool stands = false;

 private:
  /// Turns towards its next place, drives there, and now and then stands.
  void drive() {
    const double dt_s = seconds(period);
    if (rest_s_ > 0.0 || stands) {
      rest_s_ -= dt_s;
      return;
    }
    const Vec2 way = goal_ - pose.position_m;
    if (way.norm() < 0.2) {
      const std::array<Vec2, 5> places{Vec2(1.0, 1.2), Vec2(6.8, 1.0), Vec2(6.8, 5.2), Vec2(4.0, 2.5),
                                       Vec2(1.0, 5.2)};
      goal_ = places[random_.below(places.size())];
      if (random_.uniform() < 0.3) rest_s_ = random_.uniform(1.0, 8.0);
      return;
    }
    const double off_rad = wrap_angle(heading_of(way) - pose.yaw_rad);
    const double turn_rad = std::clamp(off_rad, -1.0 * dt_s, 1.0 * dt_s);
    const double forward_m = std::abs(off_rad) < 0.2 ? 0.5 * dt_s : 0.0;
    pose.yaw_rad = wrap_angle(pose.yaw_rad + turn_rad);
    pose.position_m += forward_m * Vec2(std::cos(pose.yaw_rad), std::sin(pose.yaw_rad));
    travel_.left_m += forward_m - 0.5 * track_m * turn_rad;
    travel_.right_m += forward_m + 0.5 * track_m * turn_rad;
  }

  OccupancyMap room_ = [] {
    OccupancyMap map = testing::walled_room(8.0, 6.0);
    testing::put_box(map, {5.0, 3.5}, {5.6, 4.3});
    testing::put_box(map, {2.0, 0.05}, {3.0, 0.5});
    return map;
  }();
  ObstacleField field_{room_};
  Random random_;
  int beams_;
  Vec2 goal_{6.8, 1.0};
  double rest_s_ = 0.0;
  WheelTravel travel_;
};

TEST(ScannerWatch, raises_no_false_alarm_in_an_hour_of_driving) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    ScannerWatch watch;
    Drive drive(seed);
    for (int i = 0; i < 3000; ++i) {
      const Scan scan = drive.turn(watch);
      watch.add_packets({.read = 24U * static_cast<std::uint64_t>(i), .refused = 0}, drive.now);
      ASSERT_FALSE(watch.update(scan, drive.arrival())) << "seed " << seed << ", scan " << i;
      const auto fault = watch.fault(drive.arrival());
      ASSERT_FALSE(fault) << "seed " << seed << ", scan " << i << ": " << to_string(*fault);
    }
    ASSERT_TRUE(watch.mount_turned_rad());
    EXPECT_LT(std::abs(*watch.mount_turned_rad()), radians(0.8)) << "seed " << seed;
  }
}

TEST(ScannerWatch, misses_a_scanner_after_three_tenths_of_a_second) {
  ScannerWatch watch;
  EXPECT_FALSE(watch.fault(Stamp(std::chrono::hours(2)))) << "before the first scan";
  Drive drive(1);
  drive.warm_up(watch);
  EXPECT_FALSE(watch.fault(drive.arrival() + milliseconds(300)));
  EXPECT_EQ(watch.fault(drive.arrival() + milliseconds(301)), ScannerFault::silent);
}

TEST(ScannerWatch, refuses_scans_that_are_late_or_of_another_clock) {
  for (const auto& [shift, expected] : {std::pair(milliseconds(-200), ScannerFault::late),
                                        {milliseconds(60), ScannerFault::other_clock},
                                        {milliseconds(-6000), ScannerFault::other_clock}}) {
    ScannerWatch watch;
    Drive drive(2);
    drive.warm_up(watch);
    drive.now += milliseconds(300);  // so that a late scan is not out of order
    Scan scan = drive.turn(watch);
    for (Beam& beam : scan.beams) beam.stamp += shift;
    EXPECT_EQ(watch.update(scan, drive.arrival()), expected);
    EXPECT_EQ(watch.fault(drive.arrival()), expected);
  }
}

TEST(ScannerWatch, refuses_scans_out_of_order) {
  ScannerWatch watch;
  Drive drive(2);
  drive.warm_up(watch);
  Scan scan = drive.turn(watch);
  for (Beam& beam : scan.beams) beam.stamp -= milliseconds(60);
  EXPECT_EQ(watch.update(scan, drive.arrival()), ScannerFault::other_clock);
}

TEST(ScannerWatch, notices_a_repeated_scan_driving_or_at_rest) {
  for (const bool stands : {false, true}) {
    ScannerWatch watch;
    Drive drive(3);
    drive.stands = true;  // the noise at rest is seen
    drive.warm_up(watch);
    drive.stands = stands;
    Scan frozen = drive.turn(watch);
    EXPECT_FALSE(watch.update(frozen, drive.arrival()));
    for (int i = 1; i <= 2; ++i) {
      drive.turn(watch);
      for (Beam& beam : frozen.beams) beam.stamp += period;
      EXPECT_EQ(watch.update(frozen, drive.arrival()).has_value(), i == 2) << stands;
    }
    EXPECT_EQ(watch.fault(drive.arrival()), ScannerFault::frozen);
  }
}

/// It may have been frozen from its first scan on, which the robot would notice only by driving off.
TEST(ScannerWatch, waits_ten_seconds_for_a_first_change_and_then_believes_a_scanner_without_noise) {
  ScannerWatch watch;
  Drive drive(3);
  drive.stands = true;
  Scan scan = drive.turn(watch);
  watch.update(scan, drive.arrival());
  const auto repeat = [&] {
    drive.turn(watch);
    for (Beam& beam : scan.beams) beam.stamp += period;
    return watch.update(scan, drive.arrival());
  };
  EXPECT_FALSE(repeat());
  for (int i = 2; i < 100; ++i) EXPECT_EQ(repeat(), ScannerFault::frozen) << i;
  for (int i = 100; i < 130; ++i) EXPECT_FALSE(repeat()) << i;
}

TEST(ScannerWatch, believes_a_scanner_without_noise_whose_scan_has_changed) {
  ScannerWatch watch;
  Drive drive(3);
  drive.stands = true;
  Scan scan = drive.turn(watch);
  for (int i = 0; i < 30; ++i) {
    if (i == 1) scan.beams.front().range_m += 0.5;  // something has come or gone
    EXPECT_FALSE(watch.update(scan, drive.arrival())) << i;
    drive.turn(watch);
    for (Beam& beam : scan.beams) beam.stamp += period;
  }
}

/// Spoils scans of a drive until the watch says what is wrong; how many it took.
template <typename Spoil>
int scans_until(ScannerFault expected, Spoil spoil, int most, double turned_rad = 0.0) {
  ScannerWatch watch;
  Drive drive(4);
  drive.warm_up(watch);
  Random random(9);
  for (int i = 1; i <= most; ++i) {
    Scan scan = drive.turn(watch, turned_rad);
    spoil(scan, watch, drive, random);
    watch.update(scan, drive.arrival());
    const auto fault = watch.fault(drive.arrival());
    if (fault == expected) return i;
    EXPECT_FALSE(fault) << to_string(*fault);
  }
  return most + 1;
}

TEST(ScannerWatch, notices_lost_beams_within_a_second_and_damage_within_two) {
  EXPECT_LE(scans_until(
                ScannerFault::beams_lost,
                [](Scan& scan, ScannerWatch&, Drive&, Random& random) {
                  for (Beam& beam : scan.beams)
                    if (random.uniform() < 0.4) beam.echo = Echo::invalid;
                },
                30),
            12);
  EXPECT_LE(scans_until(
                ScannerFault::checksums,
                [packets = ScanPackets{}](Scan&, ScannerWatch& watch, Drive& drive, Random& random) mutable {
                  const std::uint64_t refused = random.uniform() < 0.9 ? 3 : 1;
                  packets.read += 24 - refused;
                  packets.refused += refused;
                  watch.add_packets(packets, drive.now);
                },
                30),
            20);
}

TEST(ScannerWatch, notices_a_covered_window_within_three_tenths_of_a_second) {
  const auto covered = [](Scan& scan, ScannerWatch&, Drive&, Random&) {
    for (Beam& beam : scan.beams) beam.echo = Echo::invalid;
  };
  EXPECT_EQ(scans_until(ScannerFault::beams_lost, covered, 30), 4);
}

TEST(ScannerWatch, forgets_damage_after_two_seconds_and_with_a_driver_that_counts_anew) {
  ScannerWatch watch;
  Stamp now{std::chrono::hours(1)};
  ScanPackets packets{.read = 1000, .refused = 700};  // from before anyone watched
  const auto pass = [&](std::uint64_t read, std::uint64_t refused, int times) {
    for (int i = 0; i < times; ++i) {
      now += period;
      packets.read += read;
      packets.refused += refused;
      watch.add_packets(packets, now);
    }
  };
  pass(60, 0, 30);
  EXPECT_FALSE(watch.fault(now));
  pass(50, 10, 10);
  EXPECT_EQ(watch.fault(now), ScannerFault::checksums);
  pass(60, 0, 21);
  EXPECT_FALSE(watch.fault(now));
  pass(50, 10, 10);
  packets = {};
  pass(60, 0, 1);
  EXPECT_FALSE(watch.fault(now));
}

TEST(ScannerWatch, notices_a_motor_that_is_a_quarter_slow_and_not_one_that_is_15_percent_slow) {
  const auto slower = [](double factor) {
    return [factor](Scan& scan, ScannerWatch&, Drive& drive, Random&) {
      const Stamp first = scan.beams.front().stamp;
      for (Beam& beam : scan.beams) beam.stamp = first + from_seconds(factor * seconds(beam.stamp - first));
      drive.now += from_seconds((factor - 1.0) * seconds(period));
    };
  };
  EXPECT_EQ(scans_until(ScannerFault::motor, slower(1.0 / 0.75), 30), 5);
  EXPECT_EQ(scans_until(ScannerFault::motor, slower(1.0 / 0.85), 30), 31);
}

TEST(ScannerWatch, notices_a_dirty_window_once_the_robot_has_turned_and_driven) {
  const auto dirt = [](Scan& scan, ScannerWatch&, Drive&, Random& random) {
    for (Beam& beam : scan.beams)
      if (std::abs(beam.angle_rad - 0.5) < radians(6.0))
        beam.echo = random.uniform() < 0.5 ? Echo::invalid : Echo::too_near;
  };
  const int scans = scans_until(ScannerFault::dirty, dirt, 600);
  EXPECT_GT(scans, 20) << "not before the robot has driven 1 m";
  EXPECT_LE(scans, 300);
}

TEST(ScannerWatch, knows_the_robots_own_parts) {
  ScannerWatch watch({.hidden_rad = {{0.3, 0.7}}});
  Drive drive(4);
  for (int i = 0; i < 600; ++i) {
    Scan scan = drive.turn(watch);
    for (Beam& beam : scan.beams)
      if (std::abs(beam.angle_rad - 0.5) < radians(6.0)) beam.echo = Echo::too_near;
    watch.update(scan, drive.arrival());
    ASSERT_FALSE(watch.fault(drive.arrival()));
  }
}

TEST(ScannerWatch, notices_a_mount_that_is_turned_by_2_degrees) {
  for (const double turned_deg : {-2.0, 2.0, 4.0}) {
    const int scans = scans_until(
        ScannerFault::turned, [](Scan&, ScannerWatch&, Drive&, Random&) {}, 600, radians(turned_deg));
    EXPECT_LE(scans, 150) << turned_deg;
  }
}

}  // namespace
}  // namespace lodestar
