#include "app/bench/evidence_readers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

// Outputs as the commands print them, shortened.
namespace lodestar {
namespace {

using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;

const auto standing = [](const auto& matcher) { return Field(&EvidenceRow::standing, matcher); };

TEST(EvidenceReaders, find_the_peers_and_those_left_out_of_bench_localize) {
  const auto rows = localize_rows(R"({
    "targets": [{"name": "x threshold", "value": 3.4, "at_most": 4.0, "unit": "x", "reached": true},
                {"name": "read", "value": 90.0, "at_least": 99.5, "unit": "%", "reached": false}],
    "three_markers": {"lodestar": {"median_us": 26.3, "tilt_known": {"lateral_rms_mm": 0.0083}},
                      "apriltag": {"median_us": 2600, "tilt_known": {"lateral_rms_mm": 0.03}}},
    "centred": {"lodestar": {"median_us": 1, "tilt_known": {"lateral_rms_mm": 0.0125}}},
    "hard_frames": {"lodestar": {"adverse": {"read_right": 9, "markers_in_full_view": 10, "read_wrong": 0}}},
    "left_out": ["aruco"],
    "consistency": [{"conditions": "tilt known", "mean_nees_per_degree": 1.01, "half_band_per_degree": 0.02}]})");
  ASSERT_EQ(rows.size(), 8U);
  EXPECT_EQ(rows[0].standing, EvidenceStanding::kept);
  EXPECT_EQ(rows[1].standing, EvidenceStanding::missed);
  EXPECT_EQ(rows[2].today, "26 us");
  EXPECT_EQ(rows[2].peer, "apriltag 2600 us");
  EXPECT_EQ(rows[6].standing, EvidenceStanding::not_possible);
  EXPECT_THAT(rows[6].what, HasSubstr("aruco"));
  EXPECT_THAT(rows[7].limit, HasSubstr("0.020"));
}

TEST(EvidenceReaders, count_the_queries_that_are_not_optimal) {
  const auto rows =
      octile_rows(R"({"queries": 100, "optimal": 99, "median_us": 4.0, "plain_astar_median_us": 800.0})");
  EXPECT_THAT(rows, ElementsAre(standing(EvidenceStanding::missed), standing(EvidenceStanding::kept)));
  EXPECT_THAT(rows[1].peer, HasSubstr("800 us"));
}

TEST(EvidenceReaders, hold_plans_against_the_design) {
  const auto rows = map_rows(R"({"queries": 3, "found": 3, "plan_us": {"p99": 9000, "max": 60000},
    "travel_time_ratio": {"p99": 1.004}})");
  EXPECT_THAT(rows, ElementsAre(standing(EvidenceStanding::kept), standing(EvidenceStanding::kept),
                                standing(EvidenceStanding::missed), standing(EvidenceStanding::kept)));
}

TEST(EvidenceReaders, see_contacts_in_a_campaigns_last_lines) {
  const auto rows = campaign_rows(
      "7: contact (wheel_slip); repeat with: lodestar campaign --mission 7\n"
      "100 missions: 70 arrivals, 27 safe stops, 1 with contacts, 0 silently wrong; report: x\n"
      "2 with an excused contact, whose cause nothing on board could show\n"
      "contacts with people: 0 while moving, 2 excused, 5 at rest; at 0.00 m/s at most\n");
  EXPECT_THAT(rows, ElementsAre(standing(EvidenceStanding::missed), standing(EvidenceStanding::kept),
                                standing(EvidenceStanding::measured), standing(EvidenceStanding::measured),
                                standing(EvidenceStanding::kept), standing(EvidenceStanding::measured)));
  EXPECT_EQ(rows.at(3).today, "2");
  EXPECT_TRUE(campaign_rows("killed").empty());
}

TEST(EvidenceReaders, sum_the_runs_of_a_scenario) {
  const auto rows = scenario_rows(
      "{\"success\": true, \"contacts_moving\": 0, \"contacts_at_rest\": 1}\n"
      "{\"success\": false, \"contacts_moving\": 1, \"contacts_at_rest\": 0}\n");
  EXPECT_EQ(rows[0].today, "1");
  EXPECT_EQ(rows[0].limit, "at least 2");
  EXPECT_EQ(rows[1].standing, EvidenceStanding::missed);
  EXPECT_EQ(rows[2].today, "1");
}

TEST(EvidenceReaders, take_the_limits_that_a_survey_says_it_broke) {
  const auto rows = survey_rows(R"([{"scenario": "lab", "rms_m": 0.0009, "worst_m": 0.002, "bound_m": 0.0006,
    "broken_limits": ["RMS 0.9 mm, at most 0.8 mm"]}])");
  EXPECT_EQ(rows.at(0).standing, EvidenceStanding::missed);
  EXPECT_THAT(rows[0].today, HasSubstr("RMS 0.9 mm, at most 0.8 mm"));
}

TEST(EvidenceReaders, give_benchmarks_in_microseconds) {
  const std::string output =
      R"({"benchmarks": [{"name": "field", "cpu_time": 520000.0, "time_unit": "ns"}]})";
  EXPECT_EQ(scan_rows(output).at(0).standing, EvidenceStanding::missed);
  EXPECT_EQ(timing_rows(output).at(0).today, "520 us");
}

}  // namespace
}  // namespace lodestar
