#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenarios/faulty_drive.hpp"

// One drive through the lab for each row of the catalogue of faults that simulation can show, with its bound:
// what befalls markers and camera. Each looks first whether the fault really came before the robot's eyes.
namespace lodestar {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

constexpr double arrival_latency_s = 0.065;  ///< from mid-exposure until the navigator's next step

void expect_arrival(const FaultyDrive& drive, double within_m = 0.02) {
  ASSERT_TRUE(drive.record.arrived()) << drive.goal().failure;
  EXPECT_LT(drive.record.score_of(0)->position_error_m, within_m);
  EXPECT_EQ(drive.record.contacts, 0);
}

/// The first frame after the faults' begin that shows a marker, in the drive without faults.
const FrameSeen& first_sight() {
  return *std::ranges::find_if(usual_drive().frames, [](const FrameSeen& frame) {
    return frame.captured > fault_begin && reads_markers(frame);
  });
}

/// A fault of the marker in that frame, from just before it.
Fault of_marker_in_view(FaultKind kind) {
  return {.kind = kind,
          .begin = first_sight().captured.time_since_epoch() - milliseconds(30),
          .marker = first_sight().markers.front().id};
}

/// The ID that is read in the same frame at that marker's place. Until the fault, drives of one seed are
/// equal.
int read_instead(const FaultyDrive& drive) {
  const auto same = std::ranges::find(drive.frames, first_sight().captured, &FrameSeen::captured);
  return same == drive.frames.end() ? 0 : same->id_at(first_sight().markers.front().center_px);
}

// Where the ceiling is plain too: Navigation.when_blind_goes_back_...
TEST(Faults, row_1_without_markers_it_drives_on_by_the_ceiling) {
  const FaultyDrive blind = drive({{.kind = FaultKind::markers_occluded, .lasts = std::chrono::seconds(10)}});
  EXPECT_GT(usual_drive().frames_that(0.0, 10.0, reads_markers), 100) << "there are markers on the way";
  EXPECT_GT(blind.frames_that(0.0, 10.0, [](const FrameSeen&) { return true; }), 150);
  EXPECT_EQ(blind.frames_that(0.05, 10.0, reads_markers), 0);
  expect_arrival(blind);
  EXPECT_FALSE(blind.ever_had_to_stop());
  const std::vector<StepRecord>& steps = blind.record.steps;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const double change_mps = std::abs(steps[i].commanded.forward_mps - steps[i - 1].commanded.forward_mps);
    ASSERT_LT(change_mps, 0.03) << "at " << seconds(steps[i].estimate.stamp);
  }
}

TEST(Faults, row_2_a_marker_read_wrong_once_changes_nothing) {
  Fault fault = of_marker_in_view(FaultKind::marker_wrong_id);
  fault.lasts = milliseconds(50);
  const FaultyDrive wrong = drive({fault});
  // Its neighbour's ID in its place.
  const auto reads_neighbour = [&](const FrameSeen& frame) {
    const auto same = std::ranges::find(usual_drive().frames, frame.captured, &FrameSeen::captured);
    return same != usual_drive().frames.end() && same->count(wrong.marker()) == 1 &&
           frame.count(wrong.marker()) == 0 && frame.markers.size() == same->markers.size();
  };
  EXPECT_EQ(wrong.frames_that(0.0, 5.0, reads_neighbour), 1);
  expect_arrival(wrong);
  EXPECT_FALSE(wrong.ever_had_to_stop());
}

TEST(Faults, row_3_a_moved_marker_is_refused_at_once) {
  for (const double shift_m : {0.05, 0.2, 0.5}) {
    const FaultyDrive moved =
        drive({{.kind = FaultKind::marker_moved, .marker = 2357, .shift_m = shift_m, .direction_rad = 0.8}});
    const int marker = moved.marker();
    const auto shows_it = [&](const FrameSeen& frame) { return frame.count(marker) == 1; };
    const auto rests_on_it = [&](const FixRecord& fix) { return fix.ids == std::vector<int>{marker}; };
    EXPECT_GT(moved.frames_that(0.0, INFINITY, shows_it), 20) << shift_m;
    EXPECT_EQ(moved.fixes_that(0.0, INFINITY,
                               [&](const FixRecord& fix) { return rests_on_it(fix) && fix.accepted; }),
              0)
        << shift_m;
    EXPECT_TRUE(moved.distrusts(marker)) << shift_m;
    expect_arrival(moved);
  }
}

// A robot that tracks looks for the marker only at its registered place; one that searches the whole frame
// ignores both.
TEST(Faults, row_4_an_id_seen_twice_misleads_nobody) {
  const FaultyDrive doubled =
      drive({{.kind = FaultKind::marker_duplicated, .shift_m = 0.4, .direction_rad = 1.0}});
  EXPECT_GT(doubled.frames_that(0.0, INFINITY,
                                [&](const auto& frame) { return frame.count(doubled.marker()) > 1; }),
            10);
  for (const EstimateError& error : estimate_errors(doubled.record))
    ASSERT_LT(error.position_m, 0.05) << error.time_s;
  expect_arrival(doubled);
}

TEST(Faults, row_6_a_frozen_picture_is_no_news) {
  const FaultyDrive frozen = drive({{.kind = FaultKind::camera_frozen, .lasts = std::chrono::seconds(2)}});
  EXPECT_GT(frozen.frames_that(0.0, 2.0, [](const FrameSeen& frame) { return frame.repeats; }), 30);
  EXPECT_EQ(frozen.frames_that(-8.0, -0.1, [](const FrameSeen& frame) { return frame.repeats; }), 0);
  EXPECT_EQ(frozen.fixes_that(0.1, 1.9, is_accepted), 0);
  expect_arrival(frozen);
  EXPECT_LT(frozen.noticed_after_s("repeats"), 0.3);
}

TEST(Faults, row_7_a_camera_that_is_gone_is_missed) {
  const auto any = [](const FrameSeen&) { return true; };
  const FaultyDrive gone = drive({{.kind = FaultKind::camera_dropped, .lasts = std::chrono::seconds(2)}});
  EXPECT_GT(usual_drive().frames_that(0.0, 2.0, any), 30);
  EXPECT_EQ(gone.frames_that(0.0, 1.9, any), 0);
  expect_arrival(gone);
  constexpr double three_periods_s = 0.15;
  constexpr double step_s = 0.02;  // of the navigator
  EXPECT_LT(gone.noticed_after_s("no frames"), three_periods_s + step_s + arrival_latency_s);
}

TEST(Faults, row_8_black_and_white_pictures_are_called_so) {
  const double three_frames_s = 0.15 + arrival_latency_s;
  const FaultyDrive black = drive({{.kind = FaultKind::camera_black, .lasts = std::chrono::seconds(12)}});
  EXPECT_GT(black.frames_that(0.0, 12.0, [](const FrameSeen& frame) { return frame.mean_gray < 4.0; }), 200);
  expect_arrival(black);
  EXPECT_LT(black.noticed_after_s("nothing but black"), three_frames_s);
  const FaultyDrive white = drive({{.kind = FaultKind::camera_saturated, .lasts = std::chrono::seconds(12)}});
  EXPECT_GT(white.frames_that(0.0, 12.0, [](const FrameSeen& frame) { return frame.mean_gray > 254.0; }),
            200);
  expect_arrival(white);
  EXPECT_LT(white.noticed_after_s("nothing but white"), three_frames_s);
  const FaultyDrive blurred =
      drive({{.kind = FaultKind::camera_blurred, .lasts = std::chrono::seconds(4), .blur_sigma_px = 8.0}});
  EXPECT_GT(usual_drive().frames_that(0.0, 4.0, reads_markers), 40);
  EXPECT_EQ(blurred.frames_that(0.05, 4.0, reads_markers), 0);
  expect_arrival(blurred);
}

TEST(Faults, row_9_late_frames_are_used_up_to_250_ms_and_no_longer) {
  const auto later_than = [](double delay_s) {
    return [delay_s](const FrameSeen& frame) { return seconds(frame.arrived - frame.captured) > delay_s; };
  };
  const FaultyDrive late =
      drive({{.kind = FaultKind::camera_late, .lasts = std::chrono::seconds(6), .delay_s = 0.15}});
  EXPECT_GT(late.frames_that(0.0, 5.5, later_than(0.15)), 100);
  EXPECT_GT(late.fixes_that(0.0, 5.5, is_accepted), 50) << "late ones are used";
  expect_arrival(late);
  EXPECT_FALSE(late.ever_had_to_stop());
  const FaultyDrive too_late =
      drive({{.kind = FaultKind::camera_late, .lasts = std::chrono::seconds(6), .delay_s = 0.4}});
  EXPECT_GT(too_late.frames_that(0.0, 5.5, later_than(0.4)), 100);
  EXPECT_EQ(too_late.fixes_that(0.0, 5.5, is_accepted), 0);
  expect_arrival(too_late);
  EXPECT_LT(too_late.noticed_after_s("no frames"), 0.3) << "none comes while the first is under way";
  EXPECT_LT(too_late.noticed_after_s("too late"), 0.55);
}

TEST(Faults, row_26_a_camera_with_another_clock_is_not_believed) {
  for (const double jump_s : {3600.0, -3600.0}) {
    const FaultyDrive other =
        drive({{.kind = FaultKind::clock_jump, .lasts = std::chrono::seconds(3), .delay_s = jump_s}});
    EXPECT_GT(other.frames_that(jump_s, jump_s + 3.0, [](const FrameSeen&) { return true; }), 50);
    EXPECT_EQ(other.fixes_that(0.05, 2.95, is_accepted), 0);
    EXPECT_EQ(other.fixes_that(jump_s, jump_s + 3.0, is_accepted), 0);
    expect_arrival(other);
    EXPECT_LT(other.noticed_after_s("clock"), 0.15);
  }
}

// Markers that contradict the pose one after the other look as if the robot had been carried away.
TEST(Faults, swapped_markers_stop_the_robot) {
  const FaultyDrive swapped = drive({of_marker_in_view(FaultKind::markers_swapped)});
  const int read = read_instead(swapped);
  EXPECT_NE(read, swapped.marker());
  EXPECT_NE(read, 0) << "read as its neighbour";
  EXPECT_FALSE(swapped.record.arrived());
  EXPECT_THAT(swapped.goal().failure, HasSubstr("put elsewhere"));
  EXPECT_EQ(swapped.record.contacts, 0);
  EXPECT_LT(swapped.true_way_m(first_sight().captured), 0.5);
}

TEST(Faults, decoy_lamps_are_no_markers) {
  Fault fault = of_marker_in_view(FaultKind::decoy_lamps);
  fault.shift_m = 0.3;
  fault.count = 40.0;
  const FaultyDrive lit = drive({fault});
  int frames_with_lamps = 0;
  for (const FrameSeen& usual : usual_drive().frames) {
    const auto same = std::ranges::find(lit.frames, usual.captured, &FrameSeen::captured);
    if (same != lit.frames.end() && same->dots > usual.dots + 5) ++frames_with_lamps;
  }
  EXPECT_GT(frames_with_lamps, 10);
  expect_arrival(lit);
  EXPECT_TRUE(lit.record.distrusted.empty());
}

TEST(Faults, come_again_the_same_with_the_same_seed) {
  const std::vector<Fault> faults{{.kind = FaultKind::can_loss, .share = 0.3},
                                  {.kind = FaultKind::decoy_lamps, .shift_m = 0.3, .count = 20.0}};
  const auto track = [&](std::uint64_t seed) { return drive(faults, seed).record.truth; };
  const std::vector<TruePose> first = track(3);
  const std::vector<TruePose> second = track(3);
  ASSERT_EQ(first.size(), second.size());
  EXPECT_EQ(first.back().map_from_base.position_m, second.back().map_from_base.position_m);
  EXPECT_NE(first.back().map_from_base.position_m, track(4).back().map_from_base.position_m);
}

}  // namespace
}  // namespace lodestar
