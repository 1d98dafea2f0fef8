#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/report/run_statistics.hpp"
#include "app/simulate/simulated_drive.hpp"
#include "maps/percentile.hpp"

// One drive through the lab for each row of the catalogue of faults that simulation can show, with its bound.
namespace lodestar {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

constexpr Stamp begin{std::chrono::seconds(8)};
constexpr double arrival_latency_s = 0.065;  ///< from mid-exposure until the navigator's next step

RunRecord drive(std::vector<Fault> faults, std::uint64_t seed = 3, bool there_and_back = false) {
  static const Site lab = load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
  for (Fault& fault : faults) fault.begin = begin.time_since_epoch();
  SimulatedDriveOptions options{
      .camera = lab.default_camera, .seed = seed, .goals = lab.goals, .faults = faults};
  if (!there_and_back) options.goals.resize(1);
  return simulate_drive(lab, options);
}

void expect_arrival(const RunRecord& record, double within_m = 0.02) {
  ASSERT_TRUE(record.arrived()) << record.goals.front().failure;
  EXPECT_LT(record.score_of(0)->position_error_m, within_m);
  EXPECT_EQ(record.contacts, 0);
}

/// From the begin of the fault until the navigator said so; infinite when it never did.
double noticed_after_s(const RunRecord& record, const std::string& words) {
  for (const NoticeRecord& notice : record.notices)
    if (notice.stamp >= begin && notice.words.find(words) != std::string::npos)
      return seconds(notice.stamp - begin);
  return INFINITY;
}

bool ever_had_to_stop(const RunRecord& record) {
  return std::ranges::any_of(
      record.notices, [](const NoticeRecord& notice) { return notice.stops && notice.stamp >= begin; });
}

double true_way_m(const RunRecord& record, Stamp from, double longest_step_m = 0.05) {
  double way_m = 0.0;
  for (std::size_t i = 1; i < record.truth.size(); ++i) {
    const double step_m =
        (record.truth[i].map_from_base.position_m - record.truth[i - 1].map_from_base.position_m).norm();
    if (record.truth[i].stamp > from && step_m < longest_step_m) way_m += step_m;
  }
  return way_m;
}

// Where the ceiling is plain too: Navigation.when_blind_goes_back_...
TEST(Faults, row_1_without_markers_it_drives_on_by_the_ceiling) {
  const RunRecord record = drive({{.kind = FaultKind::markers_occluded, .lasts = std::chrono::seconds(10)}});
  expect_arrival(record);
  EXPECT_FALSE(ever_had_to_stop(record));
  for (std::size_t i = 1; i < record.steps.size(); ++i) {
    const double change_mps =
        std::abs(record.steps[i].commanded.forward_mps - record.steps[i - 1].commanded.forward_mps);
    ASSERT_LT(change_mps, 0.03) << "at " << seconds(record.steps[i].estimate.stamp);
  }
}

TEST(Faults, row_2_a_marker_read_wrong_once_changes_nothing) {
  const RunRecord record = drive({{.kind = FaultKind::marker_wrong_id, .lasts = milliseconds(50)}});
  expect_arrival(record);
  EXPECT_FALSE(ever_had_to_stop(record));
}

TEST(Faults, row_3_a_moved_marker_is_refused_at_once) {
  for (const double shift_m : {0.05, 0.2, 0.5}) {
    const RunRecord record =
        drive({{.kind = FaultKind::marker_moved, .marker = 2357, .shift_m = shift_m, .direction_rad = 0.8}});
    expect_arrival(record);
    const int marker = record.faults.front().marker.value();
    int refused = 0;
    for (const FixRecord& fix : record.fixes) {
      if (fix.stamp < begin || fix.ids != std::vector<int>{marker}) continue;
      EXPECT_FALSE(fix.accepted) << shift_m << " m, at " << seconds(fix.stamp);
      ++refused;
    }
    const bool is_named =
        std::ranges::find(record.distrusted, marker, &DistrustedMarker::id) != record.distrusted.end();
    EXPECT_TRUE(refused > 0 || is_named) << "seen with another one, it is charged without a fix of its own";
  }
}

TEST(Faults, row_4_an_id_seen_twice_tells_nothing) {
  const RunRecord record =
      drive({{.kind = FaultKind::marker_duplicated, .shift_m = 0.4, .direction_rad = 1.0}});
  expect_arrival(record);
}

TEST(Faults, row_6_a_frozen_picture_is_no_news) {
  const RunRecord record = drive({{.kind = FaultKind::camera_frozen, .lasts = std::chrono::seconds(2)}});
  expect_arrival(record);
  EXPECT_LT(noticed_after_s(record, "repeats"), 0.3);
}

TEST(Faults, row_7_a_camera_that_is_gone_is_missed) {
  const RunRecord record = drive({{.kind = FaultKind::camera_dropped, .lasts = std::chrono::seconds(2)}});
  expect_arrival(record);
  constexpr double three_periods_s = 0.15;
  constexpr double step_s = 0.02;  // of the navigator
  EXPECT_LT(noticed_after_s(record, "no frames"), three_periods_s + step_s + arrival_latency_s);
}

TEST(Faults, row_8_black_and_white_pictures_are_called_so) {
  const double three_frames_s = 0.15 + arrival_latency_s;
  const RunRecord black = drive({{.kind = FaultKind::camera_black, .lasts = std::chrono::seconds(12)}});
  expect_arrival(black);
  EXPECT_LT(noticed_after_s(black, "nothing but black"), three_frames_s);
  const RunRecord white = drive({{.kind = FaultKind::camera_saturated, .lasts = std::chrono::seconds(12)}});
  expect_arrival(white);
  EXPECT_LT(noticed_after_s(white, "nothing but white"), three_frames_s);
  expect_arrival(
      drive({{.kind = FaultKind::camera_blurred, .lasts = std::chrono::seconds(4), .blur_sigma_px = 8.0}}));
}

TEST(Faults, row_9_late_frames_are_used_up_to_250_ms_and_no_longer) {
  const RunRecord late =
      drive({{.kind = FaultKind::camera_late, .lasts = std::chrono::seconds(6), .delay_s = 0.15}});
  expect_arrival(late);
  EXPECT_FALSE(ever_had_to_stop(late));
  const RunRecord too_late =
      drive({{.kind = FaultKind::camera_late, .lasts = std::chrono::seconds(6), .delay_s = 0.4}});
  expect_arrival(too_late);
  EXPECT_LT(noticed_after_s(too_late, "no frames"), 0.3) << "none comes while the first is under way";
  EXPECT_LT(noticed_after_s(too_late, "too late"), 0.55);
  for (const FixRecord& fix : too_late.fixes) {
    const bool is_late = fix.stamp > begin && fix.stamp < begin + milliseconds(5500);
    EXPECT_FALSE(is_late && fix.accepted);
  }
}

TEST(Faults, rows_10_to_12_a_bad_cable_stops_nobody) {
  const double usual_m = percentile(drive({}).path_distances_m, 0.95).value();
  for (const Fault& fault : {Fault{.kind = FaultKind::can_loss, .share = 0.3},
                             Fault{.kind = FaultKind::can_duplication, .share = 0.3},
                             Fault{.kind = FaultKind::can_corruption, .share = 0.2},
                             Fault{.kind = FaultKind::can_delay, .delay_s = 0.01}}) {
    const RunRecord record = drive({fault});
    expect_arrival(record);
    EXPECT_LT(percentile(record.path_distances_m, 0.95).value(), usual_m + 0.015) << to_string(fault.kind);
  }
}

// Wheels that are 50 ms late contradict the camera in every turn. The robot may find no frame that confirms
// its arrival, and says so then; but it stays on its path.
TEST(Faults, row_11_late_feedback_makes_no_robot_unsteady) {
  const RunRecord late = drive({{.kind = FaultKind::can_delay, .delay_s = 0.05}});
  EXPECT_EQ(late.contacts, 0);
  EXPECT_LT(percentile(late.path_distances_m, 0.95).value(), 0.05);
  if (late.arrived()) {
    expect_arrival(late);
  } else {
    EXPECT_THAT(late.goals.front().failure, HasSubstr("cannot see that it has arrived"));
  }
}

TEST(Faults, row_23_a_stuck_encoder_stops_the_robot) {
  const RunRecord record = drive({{.kind = FaultKind::encoder_stuck}});
  EXPECT_FALSE(record.arrived());
  EXPECT_EQ(record.contacts, 0);
  EXPECT_LT(true_way_m(record, begin), 0.3);
}

TEST(Faults, row_24_markers_win_over_slipping_wheels) {
  const RunRecord record = drive(
      {{.kind = FaultKind::wheel_slip, .lasts = milliseconds(1500), .left_share = 0.4, .right_share = 0.2}});
  expect_arrival(record);
  for (const EstimateError& error : estimate_errors(record))
    ASSERT_LT(error.position_m, 0.15) << error.time_s;
}

TEST(Faults, rows_25_and_36_a_robot_carried_away_stops_and_stays) {
  const RunRecord record = drive({{.kind = FaultKind::kidnapping, .shift_m = 2.0, .turn_rad = 1.0}}, 3, true);
  EXPECT_EQ(record.contacts, 0);
  EXPECT_LT(noticed_after_s(record, ""), 0.3);
  for (const GoalRecord& goal : record.goals) {
    EXPECT_FALSE(goal.arrived);
    EXPECT_THAT(goal.failure, HasSubstr("put elsewhere")) << "no restart without a person";
  }
  EXPECT_LT(true_way_m(record, begin + milliseconds(300)), 0.4);
}

TEST(Faults, row_26_a_camera_with_another_clock_is_not_believed) {
  for (const double jump_s : {3600.0, -3600.0}) {
    const RunRecord record =
        drive({{.kind = FaultKind::clock_jump, .lasts = std::chrono::seconds(3), .delay_s = jump_s}});
    expect_arrival(record);
    EXPECT_LT(noticed_after_s(record, "clock"), 0.15);
  }
}

TEST(Faults, swapped_markers_stop_the_robot_or_do_not_mislead_it) {
  const RunRecord record = drive({{.kind = FaultKind::markers_swapped}});
  EXPECT_EQ(record.contacts, 0);
  if (record.arrived()) {
    EXPECT_LT(record.score_of(0)->position_error_m, 0.1);
  }
}

TEST(Faults, decoy_lamps_are_no_markers) {
  expect_arrival(drive({{.kind = FaultKind::decoy_lamps, .shift_m = 0.3, .count = 40.0}}));
}

TEST(Faults, come_again_the_same_with_the_same_seed) {
  const std::vector<Fault> faults{{.kind = FaultKind::can_loss, .share = 0.3},
                                  {.kind = FaultKind::decoy_lamps, .shift_m = 0.3, .count = 20.0}};
  const RunRecord first = drive(faults);
  const RunRecord second = drive(faults);
  ASSERT_EQ(first.truth.size(), second.truth.size());
  EXPECT_EQ(first.truth.back().map_from_base.position_m, second.truth.back().map_from_base.position_m);
  EXPECT_NE(first.truth.back().map_from_base.position_m,
            drive(faults, 4).truth.back().map_from_base.position_m);
}

}  // namespace
}  // namespace lodestar
