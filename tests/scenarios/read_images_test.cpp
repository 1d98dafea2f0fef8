#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <sstream>

#include "app/console/document_api.hpp"
#include "app/console/registry_json.hpp"
#include "maps/file_text.hpp"

#include "tests/scenarios/command_line.hpp"
#include "tests/scenarios/shots.hpp"

// The commands that work on files, as a user runs them: images of a known world in, rows out.
namespace lodestar {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST_F(Shots, localize_prints_a_row_for_each_image) {
  const Ran ran =
      run_lodestar("localize --markers markers.yaml --camera camera.yaml --upright frames", scratch_.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const auto rows = rows_of(ran.out);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_THAT(
      ran.out,
      StartsWith(
          "file,stamp,ids,x,y,z,yaw_deg,roll_deg,pitch_deg,sigma_x,sigma_y,sigma_yaw_deg,confidence,dots\n"));
  EXPECT_EQ(std::stod(rows[1][1]), 0.5);
  EXPECT_NEAR(std::stod(rows[1][3]), 1.2, 0.003);
  EXPECT_NEAR(std::stod(rows[1][4]), 2.1, 0.003);
  EXPECT_NEAR(std::stod(rows[1][5]), 0.6, 0.01);
  EXPECT_NEAR(std::stod(rows[1][6]), 75.0, 0.2);
  EXPECT_NEAR(std::stod(rows[2][3]), 1.3, 0.003);
  EXPECT_NEAR(std::stod(rows[2][6]), -160.0, 0.2);
  EXPECT_THAT(rows[1][2], HasSubstr("+")) << "both markers are in view and used together";
}

TEST_F(Shots, localize_prints_tum_with_eight_columns) {
  const Ran ran = run_lodestar(
      "localize --markers markers.yaml --camera camera.yaml --upright --format tum frames", scratch_.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  std::istringstream lines(ran.out);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    const std::vector<std::string> columns{std::istream_iterator<std::string>(words), {}};
    EXPECT_EQ(columns.size(), 8U) << line;
  }
}

TEST_F(Shots, localize_has_exit_code_1_when_no_marker_is_registered) {
  write_text(scratch_.path() / "others.yaml",
             "format: lodestar-markers\nversion: 1\nalignment: {x_m: 0, y_m: 0, yaw_deg: 0}\nmarkers:\n"
             "  - {id: 5, x_m: 1.0, y_m: 2.0, z_m: 2.6, yaw_deg: 30}\n");
  EXPECT_EQ(
      run_lodestar("localize --markers others.yaml --camera camera.yaml frames", scratch_.path()).exit_code,
      1);
}

TEST_F(Shots, detect_puts_the_marker_nearest_to_the_centre_first) {
  const Ran ran = run_lodestar("detect --draw seen frames/0.5.png", scratch_.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_THAT(ran.out, StartsWith("file,id,confidence,o_u,o_v,x_u,x_v,y_u,y_v,dots\n"));
  const auto rows = rows_of(ran.out);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[1][1], "447");
  EXPECT_EQ(rows[2][1], "1782");
  EXPECT_FALSE(cv::imread((scratch_.path() / "seen" / "0.5.png").string()).empty());
}

TEST_F(Shots, detect_has_exit_code_1_when_there_is_no_marker) {
  cv::imwrite((scratch_.path() / "dark.png").string(), cv::Mat::zeros(480, 640, CV_8UC1));
  EXPECT_EQ(run_lodestar("detect dark.png", scratch_.path()).exit_code, 1);
}

TEST(Plan, prints_a_path_as_json_and_a_picture) {
  const ScratchFolder scratch;
  const std::string map = std::string(LODESTAR_SOURCE_DIR) + "/sites/lab/map.yaml";
  const Ran info = run_lodestar("map info --json " + map, scratch.path());
  ASSERT_EQ(info.exit_code, 0) << info.err;
  EXPECT_EQ(nlohmann::json::parse(info.out)["columns"], 306);

  const Ran ran = run_lodestar(
      "plan --map " + map + " --start 1,1 --goal 14.3,6.5 --format json --draw plan.png", scratch.path());
  const auto plan = nlohmann::json::parse(ran.out);
  for (const char* key :
       {"status", "planner", "length_m", "turns", "travel_time_s", "plan_us", "expanded", "waypoints"}) {
    EXPECT_TRUE(plan.contains(key)) << key;
  }
  EXPECT_FALSE(cv::imread((scratch.path() / "plan.png").string()).empty());
}

TEST(Plan, has_exit_code_1_and_a_reason_when_the_goal_is_in_a_wall) {
  const ScratchFolder scratch;
  const std::string map = std::string(LODESTAR_SOURCE_DIR) + "/sites/lab/map.yaml";
  const Ran ran =
      run_lodestar("plan --map " + map + " --start 1,1 --goal 0.01,0.01 --format json", scratch.path());
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(nlohmann::json::parse(ran.out)["status"].get<std::string>(), HasSubstr("goal"));
}

TEST(Markers, check_names_overlapping_markers_with_their_line) {
  const ScratchFolder scratch;
  write_text(scratch.path() / "markers.yaml",
             "format: lodestar-markers\nversion: 1\nalignment: {x_m: 0, y_m: 0, yaw_deg: 0}\nmarkers:\n"
             "  - {id: 447, x_m: 1.0, y_m: 2.0, z_m: 2.6, yaw_deg: 0}\n"
             "  - {id: 446, x_m: 1.05, y_m: 2.0, z_m: 2.6, yaw_deg: 45}\n");
  const Ran ran = run_lodestar("markers check markers.yaml", scratch.path());
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.out, HasSubstr("markers.yaml:5: error: markers 447 and 446 overlap"));
  EXPECT_THAT(ran.out, HasSubstr("differ in one dot"));
}

TEST(Markers, check_reports_the_smallest_distances_and_their_pairs_as_json) {
  const ScratchFolder scratch;
  write_text(scratch.path() / "markers.yaml",
             "format: lodestar-markers\nversion: 1\nalignment: {x_m: 0, y_m: 0, yaw_deg: 0}\nmarkers:\n"
             "  - {id: 447, x_m: 1.0, y_m: 2.0, z_m: 2.6, yaw_deg: 0}\n"
             "  - {id: 446, x_m: 4.0, y_m: 6.0, z_m: 2.6, yaw_deg: 45}\n");
  const Ran ran = run_lodestar("markers check --json markers.yaml", scratch.path());
  EXPECT_EQ(ran.exit_code, 0) << "a warning is no error";
  const auto report = nlohmann::json::parse(ran.out);
  EXPECT_EQ(report["upright"]["smallest_distance"], 1);
  EXPECT_EQ(report["upright"]["closest_pairs"][0]["ids"], (std::vector<int>{447, 446}));
  EXPECT_EQ(report["upright"]["closest_pairs"][0]["apart_m"], 5.0);
  EXPECT_GE(report["turned_or_mirrored"]["smallest_distance"], 0);
  EXPECT_EQ(report["issues"][0]["kind"], "similar-ids");
}

/// The console checks a draft by the same rules as the command line checks the file.
TEST(Markers, check_of_a_site_says_what_the_console_says) {
  const ScratchFolder scratch;
  const std::filesystem::path site = scratch.path() / "site";
  std::filesystem::copy(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab", site,
                        std::filesystem::copy_options::recursive);
  DocumentApi console(site, scratch.path() / "runs");
  std::istringstream lab(file_text(site / "markers.yaml", "a registry"));
  std::string fewer;  // every third marker is left, one of them twice, one far away
  int number = 0;
  for (std::string line; std::getline(lab, line);) {
    if (line.find("id:") != std::string::npos && ++number % 3 != 0) continue;
    fewer += line + "\n";
    if (number == 3 && line.find("id:") != std::string::npos) fewer += line + "\n";
  }
  fewer += "  - {id: 4, x_m: 99, y_m: 2, z_m: 2.6, yaw_deg: 0}\n";
  write_text(scratch.path() / "draft.yaml", fewer);

  const Ran ran = run_lodestar("markers check --json --site site draft.yaml", scratch.path());
  EXPECT_EQ(ran.exit_code, 1) << ran.err;
  auto told = nlohmann::json::parse(ran.out)["issues"];
  std::set<std::string> kinds;
  for (auto& issue : told) {
    kinds.insert(issue["kind"].get<std::string>());
    issue.erase("line");  // a browser's draft has no line numbers
  }
  for (const char* kind : {"repeated-id", "overlapping", "outside-map", "blind-route", "gap"})
    EXPECT_TRUE(kinds.contains(kind)) << kind;

  const std::string draft = registry_json(load_registry_draft(scratch.path() / "draft.yaml")).dump();
  const HttpResponse answer =
      console.answer({.method = "POST", .target = "/api/markers/check", .body = draft});
  EXPECT_EQ(nlohmann::json::parse(answer.body), told);
}

TEST(Markers, check_of_a_site_takes_its_own_registry_and_needs_something_to_check) {
  const ScratchFolder scratch;
  const std::string lab = std::string(LODESTAR_SOURCE_DIR) + "/sites/lab";
  const Ran ran = run_lodestar("markers check --site " + lab, scratch.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("markers.yaml: warning: "));
  EXPECT_THAT(ran.out, HasSubstr("without any marker"));
  EXPECT_EQ(run_lodestar("markers check", scratch.path()).exit_code, 2);
}

TEST(Markers, that_are_generated_pass_the_check_at_their_distance) {
  const ScratchFolder scratch;
  const Ran made =
      run_lodestar("markers generate --count 40 --min-hamming 4 --seed 5 --format yaml", scratch.path());
  ASSERT_EQ(made.exit_code, 0) << made.err;
  write_text(scratch.path() / "new.yaml", made.out);
  const Ran checked = run_lodestar("markers check --json new.yaml", scratch.path());
  ASSERT_EQ(checked.exit_code, 0) << checked.out << checked.err;
  const auto report = nlohmann::json::parse(checked.out);
  EXPECT_EQ(report["markers"], 40);
  EXPECT_GE(report["upright"]["smallest_distance"], 4);
  EXPECT_GE(report["turned_or_mirrored"]["smallest_distance"], 4);
  EXPECT_TRUE(report["issues"].empty());

  const Ran more =
      run_lodestar("markers generate --count 5 --min-hamming 3 --avoid new.yaml", scratch.path());
  EXPECT_EQ(more.exit_code, 0) << more.err;
  EXPECT_EQ(rows_of(more.out).size(), 5U) << "one ID a line";
}

TEST(Markers, generate_says_how_many_there_are_when_there_are_not_enough) {
  const ScratchFolder scratch;
  const Ran ran = run_lodestar("markers generate --plain --count 257 --min-hamming 3", scratch.path());
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_EQ(ran.out, "");
  EXPECT_THAT(ran.err, HasSubstr("found 256 IDs that are 3 cells apart, wanted 257"));
}

TEST(Markers, of_the_lab_are_in_order) {
  const ScratchFolder scratch;
  const std::string lab = std::string(LODESTAR_SOURCE_DIR) + "/sites/lab/";
  EXPECT_EQ(run_lodestar("markers check " + lab + "markers.yaml --map " + lab + "map.yaml", scratch.path())
                .exit_code,
            0);
  const Ran list = run_lodestar("markers list --format csv " + lab + "markers.yaml", scratch.path());
  EXPECT_THAT(list.out, StartsWith("id,x_m,y_m,z_m,yaw_deg,dots\n"));
}

TEST(Markers, are_listed_as_json_by_the_flag_that_other_commands_have) {
  const ScratchFolder scratch;
  const std::string list = "markers list " + std::string(LODESTAR_SOURCE_DIR) + "/sites/lab/markers.yaml ";
  const Ran by_format = run_lodestar(list + "--format json", scratch.path());
  EXPECT_TRUE(nlohmann::json::accept(by_format.out));
  EXPECT_EQ(run_lodestar(list + "--json", scratch.path()).out, by_format.out);
  EXPECT_EQ(run_lodestar(list + "--json --format csv", scratch.path()).exit_code, 2);
}

}  // namespace
}  // namespace lodestar
