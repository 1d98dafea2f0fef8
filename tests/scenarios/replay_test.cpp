#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <map>
#include <nlohmann/json.hpp>

#include "app/report/run_statistics.hpp"
#include "app/simulate/simulated_drive.hpp"
#include "app/simulate/simulated_drives.hpp"
#include "maps/median.hpp"

#include "tests/scenarios/command_line.hpp"

// Whole drives: from images to the wheels and back, scored by ground truth.
namespace lodestar {
namespace {

namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

Site lab() {
  return load_site(fs::path(LODESTAR_SOURCE_DIR) / "sites/lab");
}

/// Without run.yaml, which has the time of the day.
std::map<std::string, std::string> files_in(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().filename() != "run.yaml")
      files[fs::relative(entry.path(), folder).string()] = read_text(entry.path());
  }
  return files;
}

TEST(Replay, drives_from_s_to_e_and_back) {
  const Site site = lab();
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const RunRecord record =
        simulate_drive(site, {.camera = site.default_camera, .seed = seed, .goals = site.goals});
    const RunSummary run = summarize(record);

    EXPECT_EQ(run.arrivals, 2) << "seed " << seed << ": " << run.failure;
    EXPECT_EQ(run.contacts, 0) << "seed " << seed;
    EXPECT_LT(run.worst_position_m, 0.05) << "seed " << seed;
    EXPECT_LT(run.worst_heading_rad, radians(3.0)) << "seed " << seed;
    EXPECT_LT(run.path_p95_m, 0.05) << "seed " << seed;
  }
}

/// A folder may have any name that the system allows; what was driven is written all the same.
TEST(Replay, keeps_the_results_of_a_site_whose_folder_is_named_in_latin_1) {
  const ScratchFolder scratch;
  const std::string name = "B\xFCro";
  fs::copy(fs::path(LODESTAR_SOURCE_DIR) / "sites/lab", scratch.path() / name, fs::copy_options::recursive);

  const Ran ran = run_lodestar("replay " + name + " --goal 2.2,5.6 --quiet -o run", scratch.path());

  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  const auto summary = nlohmann::json::parse(read_text(scratch.path() / "run/summary.json"));
  EXPECT_THAT(summary.at("repeat").get<std::string>(), HasSubstr("replay B\uFFFDro"));
}

/// Tiles that hang by a degree. Markers that counted as level put the robot off by 12 to 16 mm.
TEST(Replay, knows_where_it_is_to_millimetres_under_markers_that_are_not_level) {
  const Site site = lab();
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const RunRecord record = simulate_drive(site, {.camera = site.default_camera,
                                                   .seed = seed,
                                                   .goals = site.goals,
                                                   .disturbances = {.tilted_rad = radians(1.0)}});
    EXPECT_TRUE(record.arrived()) << "seed " << seed;
    std::vector<double> errors_m;
    for (const EstimateError& error : estimate_errors(record)) errors_m.push_back(error.position_m);
    EXPECT_LT(median(errors_m), 0.003) << "seed " << seed;
  }
}

TEST(Replay, puts_things_in_the_way_that_the_map_lacks) {
  const ScratchFolder scratch;
  const std::string command = "replay " LODESTAR_SOURCE_DIR "/sites/lab --seed 3 --goal 9.4,1.2 --quiet ";
  const Ran ran = run_lodestar(command + "--obstacles -o among", scratch.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("contacts while moving 0"));
  EXPECT_THAT(read_text(scratch.path() / "among/summary.json"), HasSubstr(" --obstacles\""));
  EXPECT_EQ(run_lodestar(command + "-o alone", scratch.path()).exit_code, 0);
  EXPECT_NE(read_text(scratch.path() / "among/truth.tum"), read_text(scratch.path() / "alone/truth.tum"));
}

/// A fault of the robot's disk from 1 s to 2 s.
std::string disk_fault(const std::string& kind) {
  return "format: lodestar-faults\nversion: 1\nfaults:\n  - {fault: " + kind + ", at_s: 1, for_s: 1}\n";
}

TEST(Replay, drives_the_same_way_whatever_the_disk_does_and_says_what_it_lost) {
  const ScratchFolder scratch;
  write_text(scratch.path() / "full.yaml", disk_fault("disk_full"));
  write_text(scratch.path() / "slow.yaml", disk_fault("disk_slow, delay_s: 0.3"));
  const Vec2 ahead = lab().start * Vec2(0.6, 0.0);
  const std::string command = "replay " LODESTAR_SOURCE_DIR "/sites/lab --goal " + std::to_string(ahead.x()) +
                              "," + std::to_string(ahead.y());
  EXPECT_EQ(run_lodestar(command + " -o usual", scratch.path()).exit_code, 0);
  const Ran full = run_lodestar(command + " --faults full.yaml -o full", scratch.path());
  const Ran slow = run_lodestar(command + " --faults slow.yaml -o slow", scratch.path());

  EXPECT_EQ(full.exit_code, 1);
  EXPECT_THAT(full.err, ContainsRegex("the run is not recorded as a whole: can.log: [0-9]+ of [0-9]+ are "
                                      "missing: the disk is full; run.mcap: [0-9]+ of [0-9]+ are missing"));
  EXPECT_EQ(slow.exit_code, 0) << slow.err;
  for (const char* name : {"estimate.tum", "truth.tum"})
    EXPECT_EQ(read_text(scratch.path() / "full" / name), read_text(scratch.path() / "usual" / name));
  for (const char* name : {"estimate.tum", "truth.tum", "can.log"})
    EXPECT_EQ(read_text(scratch.path() / "slow" / name), read_text(scratch.path() / "usual" / name));
  EXPECT_EQ(read_text(scratch.path() / "slow/run.mcap").size(),
            read_text(scratch.path() / "usual/run.mcap").size());
  for (const char* name : {"run.mcap", "can.log"})
    EXPECT_LT(read_text(scratch.path() / "full" / name).size(),
              read_text(scratch.path() / "usual" / name).size());
}

TEST(Replay, writes_the_same_bytes_for_the_same_seed_and_others_for_another) {
  const ScratchFolder scratch;
  const std::string lab_folder = std::string(LODESTAR_SOURCE_DIR) + "/sites/lab";
  const Site site = lab();
  const Vec2 ahead = site.start * Vec2(0.6, 0.0);
  const std::string command =
      "replay " + lab_folder + " --goal " + std::to_string(ahead.x()) + "," + std::to_string(ahead.y());
  ASSERT_EQ(run_lodestar(command + " --seed 7 -o first", scratch.path()).exit_code, 0);
  ASSERT_EQ(run_lodestar(command + " --seed 7 -o second", scratch.path()).exit_code, 0);
  ASSERT_EQ(run_lodestar(command + " --seed 8 -o other", scratch.path()).exit_code, 0);

  const auto first = files_in(scratch.path() / "first");
  for (const char* name : {"summary.json", "map.png", "estimate.tum", "truth.tum", "can.log", "report.html",
                           "site/map.pgm", "site/markers.yaml"}) {
    EXPECT_TRUE(first.contains(name)) << name;
  }
  EXPECT_EQ(first, files_in(scratch.path() / "second"));
  EXPECT_NE(first.at("truth.tum"), files_in(scratch.path() / "other").at("truth.tum"));
}

TEST(Replay, fails_with_a_reason_when_the_goal_is_in_a_wall) {
  const Site site = lab();
  const RunRecord record = simulate_drive(
      site, {.camera = site.default_camera, .seed = 1, .goals = {{Vec2(0.0, 0.0), std::nullopt}}});
  ASSERT_EQ(record.goals.size(), 1U);
  EXPECT_FALSE(record.goals[0].arrived);
  EXPECT_THAT(record.goals[0].failure, ::testing::HasSubstr("goal"));
}

/// Beside the corner of the desk at (4.0, 5.75), which touches the robot at x = 4.2. Where the path would
/// have to end so far aside that it does not count as arrived, the robot does not set out.
TEST(Replay, reaches_a_goal_beside_an_obstacle_or_does_not_set_out) {
  const Site site = lab();
  int reached = 0;
  for (int mm = 0; mm <= 20; mm += 2) {
    const Vec2 goal_m(4.2 + 0.001 * mm, 5.6);
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const RunRecord record = simulate_drive(
          site, {.camera = site.default_camera, .seed = seed, .goals = {{goal_m, std::nullopt}}});
      const GoalRecord& goal = record.goals.at(0);
      EXPECT_EQ(record.contacts, 0);
      reached += goal.arrived ? 1 : 0;
      if (goal.arrived) continue;
      EXPECT_EQ(goal.failure, "goal occupied") << mm << " mm, seed " << seed;
      EXPECT_LT(seconds(goal.travel_time), 1.0) << mm << " mm, seed " << seed;
    }
  }
  EXPECT_GE(reached, 18) << "from 10 mm on at the latest";
}

TEST(Replay, without_markers_looks_around_and_goes_nowhere) {
  Site site = lab();
  site.registry.markers.clear();
  const RunRecord record =
      simulate_drive(site, {.camera = site.default_camera, .seed = 1, .goals = site.goals});
  for (const GoalRecord& goal : record.goals) EXPECT_FALSE(goal.arrived);
  // Unequal, slipping wheels do not turn exactly on the spot.
  for (const TruePose& pose : record.truth)
    EXPECT_LT((pose.map_from_base.position_m - site.start.position_m).norm(), 0.02);
}

TEST(Replay, of_many_runs_gives_what_single_runs_give) {
  const Site site = lab();
  const Vec2 ahead = site.start * Vec2(0.4, 0.0);
  const SimulatedDriveOptions options{
      .camera = site.default_camera, .seed = 5, .goals = {{ahead, std::nullopt}}};
  const std::vector<RunSummary> runs = simulate_drives(site, options, 3, [](int) {});
  SimulatedDriveOptions last = options;
  last.seed = 7;
  const RunSummary alone = summarize(simulate_drive(site, last));
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[2].seed, 7U);
  EXPECT_EQ(runs[2].worst_position_m, alone.worst_position_m);
  EXPECT_EQ(runs[2].path_p95_m, alone.path_p95_m);
}

}  // namespace
}  // namespace lodestar
