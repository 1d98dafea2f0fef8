#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "app/simulate/simulated_drive.hpp"

// Drives through the lab by a robot whose scanner lies: how long after the fault's begin it is told so.
namespace lodestar {
namespace {

constexpr Stamp fault_begin{std::chrono::seconds(5)};
constexpr std::array<std::uint64_t, 2> seeds{1, 2};
constexpr double step_s = 0.02;      ///< of the navigator
constexpr double turn_s = 0.1;       ///< of the scanner
constexpr double delivery_s = 0.03;  ///< from the end of a turn

struct Watched {
  double noticed_after_s = INFINITY;
  std::optional<StopReason> reason;  ///< of the first notice that speaks of the scanner
  double rolled_m = 0.0;             ///< since the fault began
  int contacts = 0;
};

bool speaks_of_scanner(StopReason reason) {
  return to_string(reason).find("scanner") != std::string_view::npos;
}

/// From the lab's start, until the scanner is blamed or that long after the fault began.
Watched drive(std::vector<Fault> faults, std::uint64_t seed, Duration at_most = std::chrono::seconds(4)) {
  static const Site lab = [] {
    Site site = load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
    site.robot.scanner.emplace();
    return site;
  }();
  for (Fault& fault : faults) fault.begin = fault_begin.time_since_epoch();
  Watched watched;
  Stamp now;
  SimulatedDriveOptions options{.camera = lab.default_camera,
                                .seed = seed,
                                .goals = lab.goals,
                                .uncertainty_constraint = std::nullopt,
                                .faults = faults};
  options.watch.step = [&](const DriveMoment& moment) {
    now = moment.input.now;
    if (now < fault_begin || watched.reason) return;
    watched.rolled_m += step_s * std::abs(moment.step.navigation.command.forward_mps);
    const std::optional<StopReason> stop = moment.step.navigation.stop;
    if (!stop || !speaks_of_scanner(*stop)) return;
    watched.reason = stop;
    watched.noticed_after_s = seconds(now - fault_begin);
  };
  options.goes_on = [&] { return !watched.reason && now < fault_begin + at_most; };
  watched.contacts = simulate_drive(lab, options).contacts;
  return watched;
}

/// The longest time to one of these reasons, over drives with several seeds.
double noticed_after_s(const Fault& fault, const std::vector<StopReason>& expected) {
  double longest_s = 0.0;
  for (const std::uint64_t seed : seeds) {
    const Watched watched = drive({fault}, seed);
    EXPECT_EQ(watched.contacts, 0) << seed;
    if (watched.reason) {
      EXPECT_NE(std::ranges::find(expected, *watched.reason), expected.end()) << to_string(*watched.reason);
    }
    longest_s = std::max(longest_s, watched.noticed_after_s);
  }
  fmt::print("    noticed after {:.2f} s\n", longest_s);
  return longest_s;
}

TEST(ScannerFaults, a_sound_scanner_is_believed) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Watched sound = drive({}, seed, std::chrono::seconds(25));
    EXPECT_FALSE(sound.reason) << seed << ": " << to_string(*sound.reason);
    EXPECT_GT(sound.rolled_m, 4.0) << seed;
  }
}

TEST(ScannerFaults, silence_is_noticed_after_three_turns) {
  EXPECT_LE(noticed_after_s({.kind = FaultKind::scanner_silent}, {StopReason::scanner_silent}), 0.3 + step_s);
}

// Two repetitions, and the turn that was under way.
TEST(ScannerFaults, a_repeated_scan_is_noticed_at_its_second_repetition) {
  EXPECT_LE(noticed_after_s({.kind = FaultKind::scanner_frozen}, {StopReason::scanner_repeats}),
            3.0 * turn_s + step_s);
}

TEST(ScannerFaults, lost_beams_are_noticed_after_a_second_and_a_covered_window_sooner) {
  const auto lost = [](double share) {
    return noticed_after_s({.kind = FaultKind::scanner_beams_dropped, .share = share},
                           {StopReason::scanner_blind});
  };
  EXPECT_LE(lost(0.5), 1.0 + turn_s + step_s);
  EXPECT_LE(lost(1.0), 0.3 + turn_s + step_s);
  EXPECT_EQ(lost(0.1), INFINITY) << "no more than black and glassy surroundings lose";
}

TEST(ScannerFaults, late_scans_are_noticed_with_the_first) {
  const auto late = [](double delay_s) {
    return noticed_after_s({.kind = FaultKind::scanner_late, .delay_s = delay_s},
                           {StopReason::scanner_late, StopReason::scanner_silent});
  };
  EXPECT_LE(late(0.15), 0.15 + turn_s + step_s);
  EXPECT_LE(late(1.0), 0.3 + step_s) << "none comes while the first is under way";
  EXPECT_EQ(late(0.05), INFINITY) << "beams are used at their own time";
}

// Stamps may be ahead by the delivery and two steps, or behind by as much as late scans may be; where the
// robot turns, the map contradicts them sooner.
TEST(ScannerFaults, a_foreign_clock_is_noticed_before_it_is_far_off) {
  const auto off = [](double jump_s, double drift_s_per_s) {
    return noticed_after_s(
        {.kind = FaultKind::scanner_clock, .delay_s = jump_s, .drift_s_per_s = drift_s_per_s},
        {StopReason::scanner_clock, StopReason::scanner_late, StopReason::map_contradicted});
  };
  EXPECT_LE(off(3600.0, 0.0), turn_s + step_s);
  EXPECT_LE(off(-3600.0, 0.0), turn_s + step_s);
  EXPECT_LE(off(0.0, 0.05), (delivery_s + 2.0 * step_s) / 0.05 + turn_s);
  EXPECT_LE(off(0.0, -0.05), (0.15 - delivery_s) / 0.05 + 2.0 * turn_s);
}

TEST(ScannerFaults, a_slow_motor_is_noticed_with_its_fifth_turn) {
  const auto turning = [](double speed_share) {
    return noticed_after_s({.kind = FaultKind::scanner_motor, .share = speed_share},
                           {StopReason::scanner_motor, StopReason::scanner_silent});
  };
  EXPECT_LE(turning(0.7), turn_s + 5.0 * turn_s / 0.7 + delivery_s + step_s);
  EXPECT_LE(turning(0.2), turn_s + 0.3 + delivery_s + 2.0 * step_s) << "no scan within 0.3 s";
  EXPECT_EQ(turning(0.9), INFINITY);
}

TEST(ScannerFaults, damaged_packets_are_noticed_within_two_seconds) {
  const auto damaged = [](double share) {
    return noticed_after_s({.kind = FaultKind::scanner_packets_lost, .share = share},
                           {StopReason::scanner_damaged});
  };
  EXPECT_LE(damaged(0.15), 2.0);
  EXPECT_LE(damaged(0.5), 0.5);
  EXPECT_EQ(damaged(0.02), INFINITY);
}

// The map contradicts it at once where walls are all around; elsewhere the watch of the mount needs 70 scans
// from different places.
TEST(ScannerFaults, a_mount_turned_by_2_degrees_is_noticed_within_5_seconds) {
  for (const double turned_deg : {2.0, -2.0})
    EXPECT_LE(noticed_after_s({.kind = FaultKind::scanner_turned, .turn_rad = radians(turned_deg)},
                              {StopReason::scanner_turned, StopReason::map_contradicted}),
              5.0)
        << turned_deg;
}

// Dirt is what stays blind while the robot drives 1 m and turns by 90 degrees: the lab's way has that within
// 10 m.
TEST(ScannerFaults, a_dirty_window_is_noticed_once_the_robot_has_turned) {
  const Fault dirt{
      .kind = FaultKind::scanner_dirty, .direction_rad = radians(90.0), .width_rad = radians(12.0)};
  const Watched watched = drive({dirt}, 1, std::chrono::seconds(30));
  EXPECT_EQ(watched.reason, StopReason::scanner_dirty);
  EXPECT_GE(watched.rolled_m, 1.0);
  EXPECT_LE(watched.rolled_m, 10.0);
  fmt::print("    noticed after {:.1f} m and {:.1f} s\n", watched.rolled_m, watched.noticed_after_s);
}

// The field takes it for somebody who touches the robot.
TEST(ScannerFaults, dirt_that_reflects_stops_the_robot_by_the_field) {
  const double usual_m = drive({}, 1).rolled_m;
  for (const double direction_deg : {0.0, 90.0}) {
    const Fault dirt{.kind = FaultKind::scanner_dirty,
                     .direction_rad = radians(direction_deg),
                     .share = 1.0,
                     .width_rad = radians(12.0)};
    const double rolled_m = drive({dirt}, 1).rolled_m;
    fmt::print("    {:.0f} degrees: {:.2f} m in 4 s instead of {:.2f} m\n", direction_deg, rolled_m, usual_m);
    EXPECT_LT(rolled_m, 0.1) << direction_deg;
    EXPECT_GT(usual_m, 0.5);
  }
}

}  // namespace
}  // namespace lodestar
