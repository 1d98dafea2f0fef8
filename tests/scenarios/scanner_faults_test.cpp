#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "app/simulate/fault_files.hpp"

#include "tests/scenarios/faulty_drive.hpp"

// Drives through the lab by a robot whose scanner lies: what it does, and how long after the fault's begin.
namespace lodestar {
namespace {

constexpr std::array<std::uint64_t, 3> seeds{1, 2, 3};
constexpr double step_s = 0.02;      ///< of the navigator
constexpr double turn_s = 0.1;       ///< of the scanner
constexpr double delivery_s = 0.03;  ///< from the end of a turn

const Site& lab_with_scanner() {
  static const Site site = [] {
    Site lab = load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
    lab.robot.scanner.emplace();
    return lab;
  }();
  return site;
}

FaultyDrive drive_with_scanner(const std::vector<Fault>& faults, std::uint64_t seed) {
  const Site& site = lab_with_scanner();
  const SimulatedDriveOptions options{.camera = site.default_camera,
                                      .seed = seed,
                                      .goals = site.goals,
                                      .uncertainty_constraint = std::nullopt,
                                      .faults = faults};
  FaultyDrive drive;
  drive.record = simulate_drive(site, options);
  return drive;
}

/// The longest time from the fault's begin to one of these words, over drives with several seeds. None of
/// them ends with a contact.
double noticed_after_s(const Fault& fault, const std::vector<std::string>& words) {
  double longest_s = 0.0;
  for (const std::uint64_t seed : seeds) {
    Fault at_usual_time = fault;
    at_usual_time.begin = fault_begin.time_since_epoch();
    const FaultyDrive drive = drive_with_scanner({at_usual_time}, seed);
    EXPECT_EQ(drive.record.contacts, 0) << "seed " << seed;
    double first_s = INFINITY;
    for (const std::string& some : words) first_s = std::min(first_s, drive.noticed_after_s(some));
    longest_s = std::max(longest_s, first_s);
  }
  ::testing::Test::RecordProperty("noticed_after_s", std::to_string(longest_s));
  return longest_s;
}

/// So long that whatever is noticed at all is noticed.
constexpr Duration long_enough = std::chrono::seconds(4);

TEST(ScannerFaults, a_sound_scanner_is_believed) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const FaultyDrive sound = drive_with_scanner({}, seed);
    EXPECT_TRUE(sound.record.arrived()) << seed;
    for (const NoticeRecord& notice : sound.record.notices)
      EXPECT_EQ(notice.words.find("scanner"), std::string::npos) << seed << ": " << notice.words;
  }
}

TEST(ScannerFaults, silence_is_noticed_after_three_turns) {
  EXPECT_LE(noticed_after_s({.kind = FaultKind::scanner_silent, .lasts = long_enough}, {"sends no scans"}),
            0.3 + step_s);
}

// Two repetitions, and the turn that was under way.
TEST(ScannerFaults, a_repeated_scan_is_noticed_at_its_second_repetition) {
  EXPECT_LE(noticed_after_s({.kind = FaultKind::scanner_frozen, .lasts = long_enough}, {"repeats the same"}),
            3.0 * turn_s + step_s);
}

TEST(ScannerFaults, lost_beams_are_noticed_after_a_second_and_a_covered_window_at_once) {
  const auto lost = [](double share) {
    return noticed_after_s({.kind = FaultKind::scanner_beams_dropped, .lasts = long_enough, .share = share},
                           {"beams are lost"});
  };
  EXPECT_LE(lost(0.5), 1.0 + turn_s + step_s);
  EXPECT_LE(lost(1.0), 0.3 + turn_s + step_s);
  EXPECT_EQ(lost(0.1), INFINITY) << "no more than black and glassy surroundings lose";
}

TEST(ScannerFaults, late_scans_are_noticed_with_the_first) {
  const auto late = [](double delay_s) {
    return noticed_after_s({.kind = FaultKind::scanner_late, .lasts = long_enough, .delay_s = delay_s},
                           {"come too late", "sends no scans"});
  };
  EXPECT_LE(late(0.15), 0.15 + turn_s + step_s);
  EXPECT_LE(late(1.0), 0.3 + step_s) << "none comes while the first is under way";
  EXPECT_EQ(late(0.05), INFINITY) << "beams are used at their own time";
}

// Stamps may be ahead by a turn's delivery and a step, or behind by as much as late scans may be.
TEST(ScannerFaults, a_foreign_clock_is_noticed_before_it_is_far_off) {
  const auto off = [](double jump_s, double drift_s_per_s) {
    return noticed_after_s({.kind = FaultKind::scanner_clock,
                            .lasts = long_enough,
                            .delay_s = jump_s,
                            .drift_s_per_s = drift_s_per_s},
                           {"clock is not the robot's", "come too late"});
  };
  EXPECT_LE(off(3600.0, 0.0), turn_s + step_s);
  EXPECT_LE(off(-3600.0, 0.0), turn_s + step_s);
  EXPECT_LE(off(0.0, 0.05), (delivery_s + step_s) / 0.05 + 2.0 * turn_s);
  EXPECT_LE(off(0.0, -0.05), (0.15 - delivery_s) / 0.05 + 2.0 * turn_s);
}

TEST(ScannerFaults, a_slow_motor_is_noticed_with_its_fifth_turn) {
  const auto turning = [](double speed_share) {
    return noticed_after_s({.kind = FaultKind::scanner_motor, .lasts = long_enough, .share = speed_share},
                           {"does not turn at its speed", "sends no scans"});
  };
  EXPECT_LE(turning(0.7), turn_s + 5.0 * turn_s / 0.7 + delivery_s + step_s);
  EXPECT_LE(turning(0.2), turn_s + 0.3 + delivery_s + step_s) << "no scan within 0.3 s";
  EXPECT_EQ(turning(0.9), INFINITY);
}

TEST(ScannerFaults, damaged_packets_are_noticed_within_two_seconds) {
  const auto damaged = [](double share) {
    return noticed_after_s({.kind = FaultKind::scanner_packets_lost, .lasts = long_enough, .share = share},
                           {"arrive damaged"});
  };
  EXPECT_LE(damaged(0.15), 2.0);
  EXPECT_LE(damaged(0.5), 0.5);
  EXPECT_EQ(damaged(0.02), INFINITY);
}

}  // namespace
}  // namespace lodestar
