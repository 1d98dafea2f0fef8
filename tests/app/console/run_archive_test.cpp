#include "app/console/run_archive.hpp"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/console/run_facts.hpp"
#include "app/recording/run_origin.hpp"
#include "app/report/run_folder.hpp"

#include "tests/app/sample_run.hpp"
#include "tests/maps/temporary_folder.hpp"

// What the console's list, playback and heat map show of run folders.
namespace lodestar {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

class RunArchiveTest : public ::testing::Test {
 protected:
  void write(const std::string& name, const RunRecord& record) const {
    write_run_origin(folder_ / name,
                     {.started = "2026-11-26T09:05:00Z", .program = "1", .site = "yard", .seed = 5},
                     sample::floor(), sample::ceiling());
    write_run_folder(folder_ / name, record, sample::floor(), sample::ceiling());
  }

  /// [x, y, 3 sigma, error, blind, waiting] of the square that a point is in; null where no robot was.
  [[nodiscard]] ordered_json square(double x_m, double y_m, const std::string& site = "yard") const {
    const ordered_json heat = archive_.heat(site);
    for (const ordered_json& one : heat["squares"])
      if (std::abs(one[0].get<double>() - x_m) <= 0.125 && std::abs(one[1].get<double>() - y_m) <= 0.125)
        return one;
    return nullptr;
  }

  TemporaryFolder folder_;
  RunArchive archive_{folder_.path()};
};

TEST_F(RunArchiveTest, lists_when_a_run_was_how_it_ended_and_how_far_off_it_was) {
  RunRecord failed = sample::run();
  failed.goals[1].arrived = false;
  failed.goals[1].failure = "no way is left";
  failed.contacts = 2;
  write("a", failed);
  const ordered_json run = archive_.list().at(0);
  EXPECT_EQ(run["name"], "a");
  EXPECT_EQ(run["started"], "2026-11-26T09:05:00Z");
  EXPECT_EQ(run["site"], "yard");
  EXPECT_EQ(run["goals"], 2);
  EXPECT_EQ(run["arrived"], 1);
  EXPECT_EQ(run["why"], "no way is left");
  EXPECT_EQ(run["contacts"], 2);
  EXPECT_EQ(run["duration_s"], 4.0);
  EXPECT_EQ(run["worst_error_mm"], 80.0);
  EXPECT_EQ(run["worst_3_sigma_mm"], 60.0);
}

TEST_F(RunArchiveTest, says_of_a_real_run_what_the_robot_knew_and_no_more) {
  RunRecord real = sample::run();
  real.truth.clear();
  write("a", real);
  const ordered_json run = archive_.list().at(0);
  EXPECT_TRUE(run["worst_error_mm"].is_null());
  EXPECT_TRUE(run["contacts"].is_null()) << "nobody judged them";
  EXPECT_EQ(run["worst_3_sigma_mm"], 60.0);
}

TEST_F(RunArchiveTest, lists_a_run_without_a_report_but_does_not_open_it) {
  write_run_origin(folder_ / "killed", {.started = "2026-11-26T09:05:00Z", .program = "1", .site = "yard"},
                   sample::floor(), sample::ceiling());
  const ordered_json run = archive_.list().at(0);
  EXPECT_EQ(run["started"], "2026-11-26T09:05:00Z");
  EXPECT_TRUE(run["goals"].is_null());
  EXPECT_FALSE(archive_.run("killed"));
  write("killed", sample::run());
  EXPECT_EQ(archive_.list().at(0)["goals"], 2) << "its report has come since";
}

/// A list that is asked for while a run is being written must not keep it unfinished for good.
TEST_F(RunArchiveTest, lists_a_run_as_ended_once_its_last_file_is_there) {
  write("a", sample::run());
  fs::rename(folder_ / "a/estimate.tum", folder_ / "a/later");
  EXPECT_TRUE(archive_.list().at(0)["goals"].is_null());
  fs::rename(folder_ / "a/later", folder_ / "a/estimate.tum");
  EXPECT_EQ(archive_.list().at(0)["goals"], 2);
}

TEST_F(RunArchiveTest, a_summary_that_is_none_spoils_its_own_line_only) {
  write("a", sample::run());
  write("b", sample::run());
  std::ofstream(folder_ / "a" / "summary.json") << "{\"goals\": 7";
  fs::last_write_time(folder_ / "a" / "summary.json",
                      fs::file_time_type::clock::now() + std::chrono::hours(1));
  const ordered_json runs = archive_.list();
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0]["goals"], 2);
  EXPECT_THAT(runs[1]["why"].get<std::string>(), ::testing::HasSubstr("summary.json"));
}

TEST_F(RunArchiveTest, opens_a_run_whose_origin_somebody_else_wrote) {
  write("a", sample::run());
  std::ofstream(folder_ / "a" / "run.yaml") << "started: yesterday\n";
  EXPECT_TRUE(archive_.list().at(0)["started"].is_null());
  EXPECT_EQ(archive_.list().at(0)["goals"], 2);
  EXPECT_TRUE(archive_.run("a").value()["started"].is_null());
}

TEST_F(RunArchiveTest, has_the_map_and_the_markers_that_a_run_was_driven_on) {
  write("a", sample::run());
  const ordered_json run = archive_.run("a").value();
  EXPECT_EQ(run["map"]["columns"], 40);
  EXPECT_EQ(run["map"]["resolution_m"], 0.1);
  EXPECT_EQ(run["registry"]["markers"][0]["id"], 77);
  const std::string cells = archive_.cells("a").value();
  ASSERT_EQ(cells.size(), 800U);
  EXPECT_EQ(static_cast<int>(cells[0]), OccupancyMap::occupied);
  EXPECT_EQ(static_cast<int>(cells[20]), OccupancyMap::free);
  EXPECT_EQ(static_cast<int>(static_cast<signed char>(cells[39])), OccupancyMap::unknown);
  fs::remove_all(folder_ / "a" / "site");  // a run from before they were kept
  EXPECT_TRUE(archive_.run("a").value()["map"].is_null());
  EXPECT_FALSE(archive_.cells("a"));
}

// The sample drives from (1, 1) to (3, 1) and back at 1 m/s, sees its marker at 1 s, and is off by 10 mm more
// with each half second.
TEST_F(RunArchiveTest, heat_is_where_the_robot_was_unsure_off_blind_and_waiting) {
  RunRecord record = sample::run();
  record.notices = {{sample::at_s(3.0), "a person is near", true}, {sample::at_s(3.75), "", false}};
  write("a", record);
  const ordered_json near_end = square(1.0, 0.92);  // at 4 s, 80 mm off
  ASSERT_FALSE(near_end.is_null());
  EXPECT_EQ(near_end[2], 60.0);
  const ordered_json seen = square(2.0, 0.98);  // at 1 s, where the marker is seen; at 3 s, where it is not
  EXPECT_EQ(seen[4], 0.5) << "the half second up to 3 s";
  EXPECT_EQ(seen[3], 60.0) << "the worst of both";
  EXPECT_EQ(square(2.0, 0.94)[5], 0.75) << "of waiting, from 3 s on";
  EXPECT_TRUE(square(1.0, 0.92, "another site").is_null());
}

TEST_F(RunArchiveTest, heat_of_two_runs_is_the_worst_of_errors_and_the_sum_of_times) {
  RunRecord second = sample::run();
  for (StepRecord& step : second.steps) step.estimate.covariance *= 4.0;
  write("a", sample::run());
  const double blind_s = square(3.0, 0.96)[4];
  EXPECT_GT(blind_s, 0.0);
  write("b", second);
  const ordered_json both = square(3.0, 0.96);
  EXPECT_EQ(both[2], 120.0);
  EXPECT_EQ(both[4], 2.0 * blind_s);
  EXPECT_EQ(archive_.heat("yard")["runs"], 2);
}

}  // namespace
}  // namespace lodestar
