#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/common/parallel.hpp"
#include "drivers/base/agilex_v2.hpp"
#include "maps/percentile.hpp"

#include "tests/scenarios/faulty_drive.hpp"

// The catalogue's rows of cable, wheels, and what people do to the robot.
namespace lodestar {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

void expect_arrival(const FaultyDrive& drive, double within_m = 0.02) {
  ASSERT_TRUE(drive.record.arrived()) << drive.goal().failure;
  EXPECT_LT(drive.record.score_of(0)->position_error_m, within_m);
  EXPECT_EQ(drive.record.contacts, 0);
}

double p95_m(const FaultyDrive& drive) {
  return percentile(drive.record.path_distances_m, 0.95).value();
}

/// What came of the commands on their way to the base, one of each step: their number over that of steps, how
/// many no longer look like one, and the longest time between two.
struct CommandsOnTheWire {
  double share = 0.0;
  double spoiled_share = 0.0;
  double longest_gap_s = 0.0;
};

CommandsOnTheWire commands_of(const FaultyDrive& drive) {
  int commands = 0;
  int spoiled = 0;
  Stamp last = fault_begin;
  CommandsOnTheWire result;
  for (const StampedCanFrame& frame : drive.can_frames) {
    if (frame.stamp < fault_begin + milliseconds(100)) continue;
    // The base itself sends nothing of these identifiers, and no frame cut short.
    spoiled += frame.frame.id >= 0x700U || frame.frame.length < 8 ? 1 : 0;
    if (frame.frame.id != agilex::motion_command_id || frame.frame.length < 8) continue;
    ++commands;
    if (last > fault_begin)
      result.longest_gap_s = std::max(result.longest_gap_s, seconds(frame.stamp - last));
    last = frame.stamp;
  }
  const auto steps =
      static_cast<double>(std::ranges::count_if(drive.record.steps, [](const StepRecord& step) {
        return step.estimate.stamp >= fault_begin + milliseconds(100);
      }));
  result.share = commands / steps;
  result.spoiled_share = spoiled / steps;
  return result;
}

TEST(Faults, rows_10_to_12_a_bad_cable_stops_nobody) {
  const double usual_m = p95_m(usual_drive());
  const auto expect_as_usual = [&](const FaultyDrive& drive) {
    expect_arrival(drive);
    EXPECT_LT(p95_m(drive), usual_m + 0.015);
  };
  const CommandsOnTheWire usual = commands_of(usual_drive());
  EXPECT_NEAR(usual.share, 1.0, 0.02);
  EXPECT_EQ(usual.spoiled_share, 0.0);
  EXPECT_LT(usual.longest_gap_s, 0.0205);
  {
    SCOPED_TRACE("loss");
    const FaultyDrive lossy = drive({{.kind = FaultKind::can_loss, .share = 0.3}});
    EXPECT_NEAR(commands_of(lossy).share, 0.7, 0.06);
    expect_as_usual(lossy);
  }
  {
    SCOPED_TRACE("duplication");
    const FaultyDrive doubled = drive({{.kind = FaultKind::can_duplication, .share = 0.3}});
    EXPECT_NEAR(commands_of(doubled).share, 1.3, 0.06);
    expect_as_usual(doubled);
  }
  {
    SCOPED_TRACE("corruption");
    const FaultyDrive spoiled = drive({{.kind = FaultKind::can_corruption, .share = 0.2}});
    EXPECT_NEAR(commands_of(spoiled).spoiled_share, 0.2, 0.05);
    expect_as_usual(spoiled);
  }
  {
    SCOPED_TRACE("delay");
    const FaultyDrive late = drive({{.kind = FaultKind::can_delay, .delay_s = 0.01}});
    EXPECT_GT(commands_of(late).longest_gap_s, 0.025);
    expect_as_usual(late);
  }
}

TEST(Faults, row_23_a_stuck_encoder_stops_the_robot) {
  const FaultyDrive stuck = drive({{.kind = FaultKind::encoder_stuck}});
  double left_m = 0.0;
  double right_m = 0.0;
  for (std::size_t i = 1; i < stuck.travel.size(); ++i) {
    if (stuck.travel[i].stamp < fault_begin + milliseconds(100)) continue;
    left_m += std::abs(stuck.travel[i].left_m - stuck.travel[i - 1].left_m);
    right_m += std::abs(stuck.travel[i].right_m - stuck.travel[i - 1].right_m);
  }
  EXPECT_EQ(left_m, 0.0);
  EXPECT_GT(right_m, 0.02) << "the other one goes on";
  EXPECT_FALSE(stuck.record.arrived());
  EXPECT_THAT(stuck.goal().failure, HasSubstr("the base does not follow its commands"));
  EXPECT_EQ(stuck.record.contacts, 0);
  EXPECT_LT(stuck.true_way_m(fault_begin), 0.3);
}

TEST(Faults, row_24_markers_win_over_slipping_wheels) {
  const FaultyDrive slipping = drive(
      {{.kind = FaultKind::wheel_slip, .lasts = milliseconds(1500), .left_share = 0.4, .right_share = 0.2}});
  double reported_m = 0.0;
  const Stamp end = fault_begin + milliseconds(1500);
  for (std::size_t i = 1; i < slipping.travel.size(); ++i) {
    const WheelTravel& now = slipping.travel[i];
    const WheelTravel& before = slipping.travel[i - 1];
    if (now.stamp <= fault_begin || now.stamp > end) continue;
    reported_m += 0.5 * std::abs(now.left_m - before.left_m + now.right_m - before.right_m);
  }
  EXPECT_GT(reported_m, 0.2);
  EXPECT_LT(slipping.true_way_m(fault_begin, end), 0.85 * reported_m);
  expect_arrival(slipping);
  for (const EstimateError& error : estimate_errors(slipping.record))
    ASSERT_LT(error.position_m, 0.15) << error.time_s;
}

TEST(Faults, rows_25_and_36_a_robot_carried_away_stops_and_stays) {
  const FaultyDrive carried =
      drive({{.kind = FaultKind::kidnapping, .shift_m = 2.0, .turn_rad = 1.0}}, 3, true);
  double longest_leap_m = 0.0;
  for (std::size_t i = 1; i < carried.record.truth.size(); ++i) {
    const Vec2 step_m = carried.record.truth[i].map_from_base.position_m -
                        carried.record.truth[i - 1].map_from_base.position_m;
    longest_leap_m = std::max(longest_leap_m, step_m.norm());
  }
  EXPECT_GT(longest_leap_m, 1.0);
  EXPECT_EQ(carried.record.contacts, 0);
  EXPECT_LT(carried.noticed_after_s("the markers say that the robot is elsewhere"), 0.3);
  EXPECT_LT(carried.noticed_after_s("put elsewhere"), 1.0);
  for (const GoalRecord& goal : carried.record.goals) {
    EXPECT_FALSE(goal.arrived);
    EXPECT_THAT(goal.failure, HasSubstr("put elsewhere")) << "no restart without a person";
  }
  EXPECT_LT(carried.true_way_m(fault_begin + milliseconds(300)), 0.4);
}

/// Of drives with the same fault and other seeds.
constexpr int seeds = 24;

template <typename Look>
void for_each_seed(const Fault& fault, const Look& look) {
  std::vector<FaultyDrive> drives(seeds);
  in_parallel(seeds, [&](int i) {
    FaultyDrive one = drive({fault}, static_cast<std::uint64_t>(i) + 1);
    one.frames.clear();
    drives[static_cast<std::size_t>(i)] = std::move(one);
  });
  for (const FaultyDrive& one : drives) {
    SCOPED_TRACE("seed " + std::to_string(one.record.seed));
    look(one);
  }
}

// Wheels that are up to 50 ms late would contradict the camera in every turn, if the filter did not know.
TEST(Faults, row_11_late_feedback_makes_no_robot_unsteady) {
  for_each_seed({.kind = FaultKind::can_delay, .delay_s = 0.05}, [&](const FaultyDrive& late) {
    EXPECT_GT(commands_of(late).longest_gap_s, 0.05);
    EXPECT_EQ(late.record.contacts, 0);
    EXPECT_LT(p95_m(late), 0.02);
    expect_arrival(late);
  });
}

}  // namespace
}  // namespace lodestar
