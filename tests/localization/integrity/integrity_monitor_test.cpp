#include "localization/integrity/integrity_monitor.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace lodestar {
namespace {

using std::chrono::milliseconds;

/// A robot that drives straight along x: the wheels report that, and fixes report what a test sets.
class Drive {
 public:
  void fix(const Pose2& seen, FixOutcome outcome, std::vector<int> ids = {447}) {
    now_ += milliseconds(50);
    rolled_m_ += pace_m;
    monitor.add_travel({now_, rolled_m_, rolled_m_});
    monitor.add_fix(
        {.stamp = now_, .ids = ids, .map_from_base = seen, .expected = expected(), .outcome = outcome});
  }
  [[nodiscard]] Pose2 expected() const { return {{rolled_m_, 0.0}, 0.0}; }
  /// The estimated pose at the next fix.
  [[nodiscard]] Pose2 ahead() const { return {{rolled_m_ + pace_m, 0.0}, 0.0}; }
  [[nodiscard]] Stamp now() const { return now_; }

  IntegrityMonitor monitor;
  double pace_m = 0.03;

 private:
  Stamp now_;
  double rolled_m_ = 0.0;
};

TEST(IntegrityMonitor, has_none_while_fixes_agree) {
  Drive drive;
  for (int i = 0; i < 20; ++i) drive.fix(drive.ahead(), FixOutcome::accepted);
  EXPECT_FALSE(drive.monitor.alarm(drive.now()));
  EXPECT_EQ(drive.monitor.rolled_since_agreement_m(), 0.0);
}

TEST(IntegrityMonitor, lets_a_marker_that_hangs_elsewhere_contradict_as_long_as_it_likes) {
  Drive drive;
  for (int i = 0; i < 40; ++i) drive.fix(Pose2{{0.1, -0.1}, 0.05} * drive.ahead(), FixOutcome::refused_gate);
  EXPECT_FALSE(drive.monitor.alarm(drive.now()));
  EXPECT_FALSE(drive.monitor.take_odometry_failure());
  EXPECT_NEAR(drive.monitor.rolled_since_agreement_m(), 39 * 0.03, 1e-9)
      << "the first reading counts as no travel";
}

TEST(IntegrityMonitor, calls_an_estimate_contradicted_from_the_first_refused_fix_until_one_agrees) {
  Drive drive;
  drive.fix(drive.ahead(), FixOutcome::accepted);
  EXPECT_FALSE(drive.monitor.is_contradicted());
  drive.fix(Pose2{{0.1, -0.1}, 0.05} * drive.ahead(), FixOutcome::refused_gate);
  EXPECT_TRUE(drive.monitor.is_contradicted());
  drive.fix(Pose2{{0.1, -0.1}, 0.05} * drive.ahead(), FixOutcome::refused_late);
  EXPECT_TRUE(drive.monitor.is_contradicted());
  drive.fix(drive.ahead(), FixOutcome::accepted);
  EXPECT_FALSE(drive.monitor.is_contradicted());
}

TEST(IntegrityMonitor, blames_the_wheels_when_what_one_marker_says_changes) {
  Drive drive;
  int fixes = 0;
  while (!drive.monitor.take_odometry_failure() && fixes < 20) {
    ++fixes;
    Pose2 seen = drive.ahead();
    seen.position_m.x() *= 0.6;  // the wheels slip
    drive.fix(seen, FixOutcome::refused_gate);
  }
  EXPECT_LE(fixes, 6);
  EXPECT_EQ(drive.monitor.alarm(drive.now()), IntegrityAlarm::wheels_wrong);
  EXPECT_FALSE(drive.monitor.alarm(drive.now() + milliseconds(1001))) << "the robot may try again";
}

TEST(IntegrityMonitor, gives_up_on_wheels_that_are_wrong_again_and_again) {
  Drive drive;
  for (int i = 0; i < 40; ++i) {
    Pose2 seen = drive.ahead();
    seen.position_m.x() *= 0.5;
    drive.fix(seen, FixOutcome::refused_gate);
  }
  EXPECT_EQ(drive.monitor.alarm(drive.now() + std::chrono::hours(1)), IntegrityAlarm::wheels_broken);
}

TEST(IntegrityMonitor, stops_at_gross_contradictions_and_for_good_when_they_prevail) {
  Drive drive;
  const Pose2 elsewhere{{2.0, 1.0}, 0.5};
  drive.fix(elsewhere * drive.ahead(), FixOutcome::refused_gate);
  EXPECT_FALSE(drive.monitor.alarm(drive.now())) << "one fix may be a misread marker";
  drive.fix(elsewhere * drive.ahead(), FixOutcome::refused_gate);
  EXPECT_EQ(drive.monitor.alarm(drive.now()), IntegrityAlarm::contradicted);
  drive.fix(elsewhere * drive.ahead(), FixOutcome::relocated);
  EXPECT_EQ(drive.monitor.alarm(drive.now()), IntegrityAlarm::carried_away);
  drive.fix(drive.ahead(), FixOutcome::accepted);
  EXPECT_EQ(drive.monitor.alarm(drive.now()), IntegrityAlarm::carried_away);
}

/// While it brakes: 18 mm by the right wheel, which the robot believes to have turned it by 5 degrees.
TEST(IntegrityMonitor, takes_the_wheel_that_rolls_where_the_other_ones_encoder_is_stuck) {
  IntegrityMonitor monitor;
  for (int i = 0; i <= 6; ++i) {
    const Stamp now = Stamp{} + milliseconds(50 * i);
    monitor.add_travel({now, 0.0, 3e-3 * i});
    monitor.add_fix({.stamp = now,
                     .ids = std::vector{447},
                     .map_from_base = Pose2{},
                     .expected = Pose2{{0.0, 0.0}, radians(1.0 + 0.85 * i)},
                     .outcome = FixOutcome::refused_gate});
  }
  EXPECT_EQ(monitor.alarm(Stamp{} + milliseconds(300)), IntegrityAlarm::wheels_wrong);
}

/// A machine that was busy takes the pictures of 100 ms one after another.
TEST(IntegrityMonitor, compares_with_what_the_wheels_had_rolled_at_the_exposure) {
  IntegrityMonitor monitor;
  const auto at = [](int ms) { return Stamp{} + milliseconds(ms); };
  for (int ms = 0; ms <= 200; ms += 20) monitor.add_travel({at(ms), 5e-4 * ms, 5e-4 * ms});
  const auto fix = [&](int ms, double yaw_rad) {
    monitor.add_fix({.stamp = at(ms),
                     .ids = std::vector{447},
                     .map_from_base = {{5e-4 * ms, 0.0}, yaw_rad},
                     .expected = Pose2{{5e-4 * ms, 0.0}, 0.0},
                     .outcome = FixOutcome::refused_gate});
  };
  fix(50, 0.05);
  fix(100, 0.15);
  EXPECT_EQ(monitor.alarm(at(200)), IntegrityAlarm::wheels_wrong);
}

TEST(IntegrityMonitor, waits_a_moment_where_the_estimate_has_moved_a_little) {
  Drive drive;
  drive.fix(Pose2{{0.1, 0.0}, 0.0} * drive.ahead(), FixOutcome::relocated);
  EXPECT_EQ(drive.monitor.alarm(drive.now()), IntegrityAlarm::moved);
  EXPECT_FALSE(drive.monitor.alarm(drive.now() + milliseconds(1001)));
}

TEST(IntegrityMonitor, does_not_let_a_belief_begin_anew_out_of_the_wheels_reach) {
  for (const double aside_m : {0.1, 2.0}) {
    Drive drive;
    while (!drive.monitor.take_odometry_failure()) {
      Pose2 seen = drive.ahead();
      seen.position_m.x() *= 0.6;
      drive.fix(seen, FixOutcome::refused_gate);
    }
    drive.fix(Pose2{{0.0, aside_m}, 0.0} * drive.ahead(), FixOutcome::started, {2400});
    const auto later = drive.now() + std::chrono::hours(1);
    EXPECT_EQ(drive.monitor.alarm(later),
              aside_m > 1.0 ? std::optional(IntegrityAlarm::carried_away) : std::nullopt);
  }
}

/// The error by one marker changes while the wheels slip. A marker that fell first jumped away before they
/// did.
TEST(IntegrityMonitor, lets_no_belief_begin_by_a_marker_alone_that_jumped_farther_than_the_wheels_rolled) {
  for (const double jump_m : {0.0, 0.08, 0.28}) {
    for (const std::vector<int>& starts_by : {std::vector{447}, std::vector{447, 2400}}) {
      Drive drive;
      drive.fix(drive.ahead(), FixOutcome::accepted);
      while (!drive.monitor.take_odometry_failure()) {
        Pose2 seen = drive.ahead();
        seen.position_m = {0.6 * seen.position_m.x(), jump_m};
        drive.fix(seen, FixOutcome::refused_gate);
      }
      drive.fix(Pose2{{0.0, jump_m}, 0.0} * drive.ahead(), FixOutcome::started, starts_by);
      const bool is_by_it_alone = starts_by.size() == 1;
      EXPECT_EQ(drive.monitor.alarm(drive.now() + std::chrono::hours(1)),
                jump_m > 0.0 && is_by_it_alone ? std::optional(IntegrityAlarm::carried_away) : std::nullopt)
          << jump_m << " m, by " << starts_by.size();
    }
  }
}

/// At 0.6 m/s and 0.2 s late, the wheels have rolled 12 cm between exposure and arrival.
TEST(IntegrityMonitor, takes_late_frames_for_no_jump) {
  IntegrityMonitor monitor;
  const auto fix_late = [&](double x_m, milliseconds exposed, FixOutcome outcome) {
    monitor.add_fix({.stamp = Stamp{} + exposed,
                     .ids = std::vector{447},
                     .map_from_base = {{x_m, 0.0}, 0.0},
                     .expected = Pose2{{1e-3 * 0.6 * static_cast<double>(exposed.count()), 0.0}, 0.0},
                     .outcome = outcome});
  };
  for (milliseconds at{0}; at <= milliseconds(800); at += milliseconds(20)) {
    const double rolled_m = 1e-3 * 0.6 * static_cast<double>(at.count());
    monitor.add_travel({Stamp{} + at, rolled_m, rolled_m});
    if (at == milliseconds(300)) fix_late(0.06, milliseconds(100), FixOutcome::accepted);
    if (at == milliseconds(500)) fix_late(0.18, milliseconds(300), FixOutcome::refused_gate);
    if (at == milliseconds(800)) fix_late(0.20, milliseconds(600), FixOutcome::refused_gate);
  }
  ASSERT_TRUE(monitor.take_odometry_failure());
  monitor.add_fix({.stamp = Stamp{} + milliseconds(650),
                   .ids = std::vector{447},
                   .map_from_base = {{0.21, 0.0}, 0.0},
                   .outcome = FixOutcome::started});
  EXPECT_FALSE(monitor.alarm(Stamp{} + std::chrono::hours(1)));
}

TEST(IntegrityMonitor, knows_a_robot_that_moves_without_its_wheels) {
  Drive drive;
  drive.pace_m = 0.0;
  drive.fix({{0.1, 0.0}, 0.0}, FixOutcome::refused_gate);
  drive.fix({{0.2, 0.0}, 0.0}, FixOutcome::refused_gate);
  EXPECT_EQ(drive.monitor.alarm(drive.now()), IntegrityAlarm::carried_away);
}

}  // namespace
}  // namespace lodestar
