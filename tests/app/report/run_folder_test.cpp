#include "app/report/run_folder.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/report/run_statistics.hpp"
#include "maps/input_error.hpp"

#include "tests/app/sample_run.hpp"
#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

constexpr std::array file_names{"summary.json", "map.png",   "estimate.tum", "truth.tum",
                                "steps.csv",    "fixes.csv", "report.html"};

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::istringstream in(content_of(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

class RunFolder : public testing::Test {
 protected:
  void write(const fs::path& where, const RunRecord& record = sample::run()) const {
    write_run_folder(where, record, sample::floor(), sample::ceiling());
  }

  TemporaryFolder parent;
  fs::path folder = parent / "run";
};

TEST_F(RunFolder, holds_every_file_and_nothing_else) {
  write(folder / "deep" / "run");
  for (const char* name : file_names) EXPECT_GT(fs::file_size(folder / "deep" / "run" / name), 0U) << name;
  const auto count = std::distance(fs::directory_iterator(folder / "deep" / "run"), {});
  EXPECT_EQ(count, static_cast<std::ptrdiff_t>(file_names.size()));
}

TEST_F(RunFolder, proposes_the_new_places_of_markers_that_the_robot_distrusts) {
  RunRecord record = sample::run();
  record.distrusted = {{.id = 447,
                        .offset_m = {0.05, -0.02},
                        .turn_rad = radians(4.0),
                        .fixes = 9,
                        .sigma_m = 0.004,
                        .sigma_rad = radians(0.5)}};
  write(folder, record);
  const std::vector<std::string> lines = lines_of(folder / "proposals.csv");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0], "id,change,dx_m,dy_m,dyaw_deg,sigma_xy_m,sigma_yaw_deg");
  EXPECT_EQ(lines[1], "447,moved,0.05000,-0.02000,4.0000,0.00400,0.5000");
  write(folder);
  EXPECT_FALSE(fs::exists(folder / "proposals.csv")) << "that of a drive before";
}

TEST_F(RunFolder, is_the_same_byte_for_byte_however_long_the_run_took) {
  RunRecord slow = sample::run();
  slow.wall_time_s = 1234.5;
  write(folder / "a");
  write(folder / "b", slow);
  for (const char* name : file_names) {
    EXPECT_EQ(content_of(folder / "a" / name), content_of(folder / "b" / name)) << name;
  }
}

TEST_F(RunFolder, tracks_are_eight_columns_with_the_quaternion_last) {
  RunRecord record = sample::run();
  record.truth[1].map_from_base.yaw_rad = radians(90.0);
  write(folder, record);
  const std::vector<std::string> lines = lines_of(folder / "truth.tum");
  ASSERT_EQ(lines.size(), 9U);
  EXPECT_EQ(lines[0],
            "0.000000000 1.000000 1.000000 0.000000 0.000000000 0.000000000 0.000000000 1.000000000");
  EXPECT_EQ(lines[1],
            "0.500000000 1.500000 1.000000 0.000000 0.000000000 0.000000000 0.707106781 0.707106781");
}

TEST_F(RunFolder, a_repeated_estimate_is_written_once) {
  RunRecord record = sample::run();
  record.steps.insert(record.steps.begin() + 3, record.steps[3]);
  write(folder, record);
  EXPECT_EQ(lines_of(folder / "estimate.tum").size(), 9U);
}

TEST_F(RunFolder, summary_says_what_can_be_worked_out_by_hand) {
  write(folder);
  const auto summary = nlohmann::json::parse(content_of(folder / "summary.json"));
  EXPECT_EQ(summary["site"], "yard");
  EXPECT_EQ(summary["seed"], 5);
  EXPECT_EQ(summary["repeat"], "lodestar replay yard --seed 5");
  EXPECT_EQ(summary["arrived"], true);
  EXPECT_EQ(summary["start"]["x_m"], 1.0);
  EXPECT_NEAR(summary["driven_m"], 4.0, 1e-12);
  EXPECT_EQ(summary["path_distance_m"]["p50"], 0.010);
  EXPECT_EQ(summary["path_distance_m"]["p95"], 0.019);
  EXPECT_EQ(summary["path_distance_m"]["max"], 0.020);
  EXPECT_NEAR(summary["estimate_position_error_m"]["p50"], 0.04, 1e-12);
  EXPECT_NEAR(summary["estimate_position_error_m"]["max"], 0.08, 1e-12);
  EXPECT_EQ(summary["estimate_heading_error_deg"]["max"], 0.0);
  EXPECT_EQ(summary["frames"], 3);
  EXPECT_EQ(summary["fixes_accepted"], 1);
  EXPECT_EQ(summary["fixes_refused"], 1);
  EXPECT_NEAR(summary["mean_confidence"], 0.8, 1e-12);
  EXPECT_EQ(summary["duration_s"], 4.0);
  EXPECT_NEAR(summary["largest_position_sigma_m"], 0.02, 1e-12);
  ASSERT_EQ(summary["goals"].size(), 2U);
  EXPECT_EQ(summary["goals"][1]["ended_s"], 4.0);
  EXPECT_EQ(summary["goals"][0]["planned_length_m"], 2.0);
  EXPECT_EQ(summary["goals"][0]["turns"], 0);
  EXPECT_EQ(summary["goals"][0]["position_error_m"], 0.004);
  EXPECT_TRUE(summary["goals"][0]["heading_error_deg"].is_null());
}

TEST_F(RunFolder, of_a_real_robot_tells_how_far_it_drove_by_its_own_estimate) {
  RunRecord record = sample::run();
  record.truth.clear();
  record.notices = {{sample::at_s(1.5), "something stands in the way", true}, {sample::at_s(2.0), "", false}};
  write(folder, record);
  const auto summary = nlohmann::json::parse(content_of(folder / "summary.json"));
  EXPECT_NEAR(summary["driven_m"], 4.0, 0.01);
  ASSERT_EQ(summary["notices"].size(), 2U);
  EXPECT_EQ(summary["notices"][0]["at_s"], 1.5);
  EXPECT_EQ(summary["notices"][0]["words"], "something stands in the way");
  EXPECT_EQ(summary["notices"][0]["stops"], true);
}

TEST_F(RunFolder, a_run_that_went_nowhere_is_told_too) {
  RunRecord record;
  record.goals.emplace_back();
  record.goals[0].failure = "no way";
  write(folder, record);
  const auto summary = nlohmann::json::parse(content_of(folder / "summary.json"));
  EXPECT_EQ(summary["arrived"], false);
  EXPECT_EQ(summary["goals"][0]["failure"], "no way");
  EXPECT_TRUE(summary["path_distance_m"]["p95"].is_null());
  EXPECT_FALSE(fs::exists(folder / "truth.tum")) << "nobody knows it";
}

TEST_F(RunFolder, that_cannot_be_made_is_an_input_error) {
  fs::create_directories(folder);
  std::ofstream(folder / "file") << "in the way";
  EXPECT_THROW(write(folder / "file"), InputError);
  EXPECT_THROW(write(folder / "file" / "run"), InputError);
}

TEST(RunStatistics, estimate_is_compared_with_the_truth_at_its_own_stamp) {
  RunRecord record = sample::run();
  record.steps.resize(1);
  record.steps[0].estimate.stamp = sample::at_s(0.7);
  record.steps[0].estimate.map_from_base = {{1.7, 1.0}, 0.1};
  const std::vector<EstimateError> errors = estimate_errors(record);
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_NEAR(errors[0].position_m, 0.0, 1e-12);
  EXPECT_NEAR(errors[0].heading_rad, 0.1, 1e-12);
  EXPECT_NEAR(errors[0].position_sigma_m, 0.02, 1e-12);
  EXPECT_NEAR(errors[0].heading_sigma_rad, 0.001, 1e-12);
}

TEST(RunStatistics, truth_is_interpolated_the_short_way_round) {
  RunRecord record = sample::run();
  record.truth[0].map_from_base.yaw_rad = radians(170.0);
  record.truth[1].map_from_base.yaw_rad = radians(-170.0);
  record.steps.resize(1);
  record.steps[0].estimate.stamp = sample::at_s(0.25);
  record.steps[0].estimate.map_from_base.yaw_rad = radians(180.0);
  EXPECT_NEAR(estimate_errors(record)[0].heading_rad, 0.0, 1e-12);
}

TEST(RunStatistics, track_is_parted_where_a_goal_ended) {
  const std::vector<std::vector<TruePose>> parts = parts_of_track(sample::run());
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].size(), 5U);
  EXPECT_EQ(parts[1].front().stamp, sample::at_s(2.5));
}

}  // namespace
}  // namespace lodestar
