#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "tests/scenarios/command_line.hpp"

namespace lodestar {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string head = "format: lodestar-scenario\nversion: 1\n";
const std::string hall = head +
                         "size_m: [6, 4]\nstart: {x_m: 1, y_m: 2, yaw_deg: 0}\n"
                         "goal: {x_m: 4, y_m: 2, radius_m: 0.1}\ntime_limit_s: 40\n";

std::vector<nlohmann::ordered_json> lines_of(const Ran& ran) {
  std::vector<nlohmann::ordered_json> lines;
  std::istringstream text(ran.out);
  for (std::string line; std::getline(text, line);) lines.push_back(nlohmann::ordered_json::parse(line));
  return lines;
}

Ran run_scenario_text(const ScratchFolder& scratch, const std::string& text, const std::string& options) {
  write_text(scratch.path() / "world.yaml", text);
  return run_lodestar("scenario world.yaml " + options, scratch.path());
}

TEST(Scenario, drives_through_an_empty_hall_and_prints_one_object_a_seed) {
  const ScratchFolder scratch;
  const Ran ran = run_scenario_text(scratch, hall, "--json --seed 7 --seeds 2 -o pictures");
  ASSERT_EQ(ran.exit_code, 0) << ran.err << ran.out;
  const auto lines = lines_of(ran);
  ASSERT_EQ(lines.size(), 2U);
  std::vector<std::string> keys;
  for (const auto& [key, value] : lines[0].items()) keys.push_back(key);
  EXPECT_THAT(keys,
              ElementsAre("seed", "success", "time_s", "length_m", "contacts_moving", "contacts_excused",
                          "contacts_at_rest", "greatest_contact_mps", "least_clearance_m", "reason"));
  EXPECT_EQ(lines[0]["seed"], 7);
  EXPECT_EQ(lines[1]["seed"], 8);
  EXPECT_EQ(lines[0]["success"], true);
  EXPECT_EQ(lines[0]["reason"], "arrived");
  EXPECT_NEAR(lines[0]["length_m"].get<double>(), 3.0, 0.2);
  EXPECT_GT(lines[0]["time_s"].get<double>(), 5.0) << "3 m at 0.6 m/s at most";
  EXPECT_TRUE(lines[0]["least_clearance_m"].is_null()) << "there is nothing to come near to";
  EXPECT_TRUE(std::filesystem::exists(scratch.path() / "pictures" / "scenario-8.png"));
  EXPECT_EQ(run_scenario_text(scratch, hall, "--json --seed 7 --seeds 2").out, ran.out)
      << "repeats by its seed";
}

TEST(Scenario, counts_a_fast_disc_s_contact_as_excused) {
  const ScratchFolder scratch;
  // Faster than anyone the robot promises to stop for, along its way.
  const Ran ran = run_scenario_text(scratch,
                                    hall +
                                        "discs: [{radius_m: 0.3, legs: false, keys: [[0, 5.5, 2], [2, 5.5, "
                                        "2], [3, 0.4, 2]], loop: true}]\n",
                                    "--json --seed 1");
  const auto lines = lines_of(ran);
  ASSERT_EQ(lines.size(), 1U) << ran.err;
  EXPECT_EQ(lines[0]["contacts_moving"], 0);
  EXPECT_GT(lines[0]["contacts_excused"].get<int>() + lines[0]["contacts_at_rest"].get<int>(), 0);
  EXPECT_LT(lines[0]["least_clearance_m"].get<double>(), 0.0);
}

/// The lab's robot with a scanner, and more.
std::string robot_with(const std::string& more) {
  std::ifstream file(std::string(LODESTAR_SOURCE_DIR) + "/sites/lab/robot.yaml");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str() + "scanner: {x_m: 0, y_m: 0, z_m: 0.2, yaw_deg: 0, protective_deceleration_mps2: 1.5}\n" +
         more;
}

TEST(Scenario, drives_around_a_table_that_only_a_depth_camera_sees) {
  const ScratchFolder scratch;
  const std::string world = head +
                            "size_m: [8, 4]\nstart: {x_m: 1, y_m: 2.2, yaw_deg: 0}\nrobot: robot.yaml\n"
                            "goal: {x_m: 7, y_m: 2.2, radius_m: 0.1}\ntime_limit_s: 90\n"
                            "overhangs: [{x_m: [3.5, 4.3], y_m: [1.2, 4.0], z_m: [0.7, 0.74]}]\n";
  write_text(scratch.path() / "robot.yaml", robot_with(""));
  const auto blind = lines_of(run_scenario_text(scratch, world, "--json --seeds 3"));
  ASSERT_EQ(blind.size(), 3U);
  for (const auto& line : blind) EXPECT_EQ(line["success"], false) << "the beams pass below: " << line;
  write_text(
      scratch.path() / "robot.yaml",
      robot_with("depth_camera: {x_m: 0.2, y_m: 0, z_m: 0.5, yaw_deg: 0, pitch_down_deg: 10, width_px: 640, "
                 "height_px: 480, fx_px: 385, fy_px: 385, cx_px: 320, cy_px: 240, range_m: 3.5, "
                 "robot_height_m: 1.1}\n"));
  const auto seeing = lines_of(run_scenario_text(scratch, world, "--json --seeds 3"));
  ASSERT_EQ(seeing.size(), 3U);
  for (const auto& line : seeing) {
    EXPECT_EQ(line["success"], true) << line;
    EXPECT_GT(line["least_clearance_m"].get<double>(), 0.0) << line;
    EXPECT_GT(line["length_m"].get<double>(), 6.2) << "around it";
  }
}

/// Driving off would be a contact of a robot that moves.
TEST(Scenario, stays_while_someone_who_has_come_leans_on_the_robot) {
  const ScratchFolder scratch;
  std::string text = hall +
                     "discs: [{radius_m: 0.25, legs: true, keys: [[0, 0.5, 3.4], [0.8, 0.7, 2.3], [40, 0.7, "
                     "2.3], [42, 0.5, 3.7]]}]\n";
  text.replace(text.find("time_limit_s: 40"), 16, "time_limit_s: 90");
  for (const auto& line : lines_of(run_scenario_text(scratch, text, "--json --seeds 3"))) {
    EXPECT_EQ(line["success"], true) << line;
    EXPECT_GT(line["time_s"].get<double>(), 42.0) << line;
    EXPECT_EQ(line["contacts_moving"], 0) << line;
    EXPECT_EQ(line["contacts_at_rest"], 1) << line;
  }
}

TEST(Scenario, gives_up_at_its_time_limit) {
  const ScratchFolder scratch;
  std::string text = hall;
  text.replace(text.find("time_limit_s: 40"), 16, "time_limit_s: 3");
  const Ran ran = run_scenario_text(scratch, text, "--json");
  EXPECT_EQ(ran.exit_code, 1);
  const auto lines = lines_of(ran);
  ASSERT_EQ(lines.size(), 1U) << ran.err;
  EXPECT_EQ(lines[0]["success"], false);
  EXPECT_EQ(lines[0]["reason"], "time limit");
  EXPECT_NEAR(lines[0]["time_s"].get<double>(), 3.0, 0.05);
}

TEST(Scenario, starts_without_markers_where_a_person_says) {
  const ScratchFolder scratch;
  std::string text = hall + "markers: none\nlimits: {max_forward_mps: 0.3}\n";
  text.replace(text.find("radius_m: 0.1"), 13, "radius_m: 0.5");  // by wheels alone
  const Ran ran = run_scenario_text(scratch, text, "--json");
  const auto lines = lines_of(ran);
  ASSERT_EQ(lines.size(), 1U) << ran.err;
  EXPECT_EQ(lines[0]["success"], true) << lines[0].dump();
  EXPECT_GT(lines[0]["time_s"].get<double>(), 9.0) << "3 m at 0.3 m/s";
}

TEST(Scenario, says_where_its_file_is_wrong) {
  const ScratchFolder scratch;
  const auto complaint = [&](const std::string& text) {
    const Ran ran = run_scenario_text(scratch, text, "--json");
    EXPECT_EQ(ran.exit_code, 2) << text;
    EXPECT_EQ(ran.out, "");
    return ran.err;
  };
  EXPECT_THAT(complaint(hall + "speed: 3\n"), HasSubstr("world.yaml:7: found unknown key 'speed'"));
  EXPECT_THAT(complaint(head + "size_m: [6, 4]\n"), HasSubstr("no key 'start'"));
  EXPECT_THAT(complaint(hall + "map: lab.yaml\n"), HasSubstr("a size besides a map"));
  EXPECT_THAT(complaint(hall + "markers: some\n"), HasSubstr("hang or none"));
  EXPECT_THAT(complaint(hall + "limits: {max_mps: 1}\n"), HasSubstr("unknown key 'max_mps'"));
  EXPECT_THAT(complaint(hall + "robot: no_such.yaml\n"), HasSubstr("no_such.yaml"));
  EXPECT_THAT(complaint(hall + "discs:\n  - {radius_m: 0.3, keys: []}\n"), HasSubstr("empty list"));
  EXPECT_THAT(complaint(hall + "discs:\n  - {radius_m: 0.3, keys: [[0, 1]]}\n"),
              HasSubstr("world.yaml:8: found 2 values"));
  EXPECT_THAT(
      complaint(hall + "discs:\n  - {radius_m: 0.3, keys: [[1, 1, 1],\n            [1, 2, 2]]}\n"),
      HasSubstr("world.yaml:9: found [1, 2, 2], wanted a list of [t_s, x_m, y_m], their times ascending"));
  EXPECT_THAT(run_lodestar("scenario", scratch.path()).err, HasSubstr("file"));
}

TEST(Scenario, reads_the_examples) {
  const ScratchFolder scratch;
  for (const char* name : {"crossing-people", "static-clutter", "heaps-of-posts", "gaps-in-rows",
                           "narrow-ways", "lone-posts", "people-who-stand-about", "corridor"}) {
    // So short a time shows that the files are read, and no more.
    std::string text = read_text(std::string(LODESTAR_SOURCE_DIR) + "/scenarios/" + name + ".yaml");
    const std::size_t at = text.find("time_limit_s: ");
    ASSERT_NE(at, std::string::npos);
    text.replace(at, text.find('\n', at) - at, "time_limit_s: 0.5");
    for (const char* part : {"corridor_map.yaml", "corridor_map.pgm"})
      write_text(scratch.path() / part, read_text(std::string(LODESTAR_SOURCE_DIR) + "/scenarios/" + part));
    const Ran ran = run_scenario_text(scratch, text, "--json");
    EXPECT_EQ(ran.exit_code, 1) << name << ran.err;
    EXPECT_THAT(ran.out, HasSubstr("time limit")) << name;
  }
}

/// Of eight drives of an example, with another seed each.
int arrivals_of(const std::string& example) {
  const ScratchFolder scratch;
  const std::string file = LODESTAR_SOURCE_DIR "/scenarios/" + example + ".yaml";
  const Ran ran = run_lodestar("scenario '" + file + "' --json --seeds 8", scratch.path());
  int arrived = 0;
  for (const auto& line : lines_of(ran)) {
    EXPECT_EQ(line["contacts_moving"], 0) << line;
    if (line["success"].get<bool>()) ++arrived;
  }
  return arrived;
}

/// A robot that drives up to people who sway may not even turn there.
TEST(Scenario, drives_around_people_who_stand_and_sway) {
  EXPECT_GE(arrivals_of("people-who-stand-about"), 7);
}

/// In a gap it looks along the row, and took the posts for people: one of eight arrived.
TEST(Scenario, drives_through_gaps_in_rows_of_posts) {
  EXPECT_GE(arrivals_of("gaps-in-rows"), 7);
}

/// Where no way looked open it turned to and fro before them all: seven of sixteen arrived.
TEST(Scenario, drives_on_where_each_way_looks_shut_now_and_then) {
  EXPECT_GE(arrivals_of("narrow-ways"), 7);
}

/// Of an example, with another seed each; all arrive.
std::vector<nlohmann::ordered_json> four_drives_of(const std::string& example) {
  const ScratchFolder scratch;
  const std::string file = LODESTAR_SOURCE_DIR "/scenarios/" + example + ".yaml";
  const Ran ran = run_lodestar("scenario '" + file + "' --json --seeds 4", scratch.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  return lines_of(ran);
}

/// Discs stand in the straight way; no map has them.
TEST(Scenario, drives_around_what_stands) {
  for (const auto& line : four_drives_of("static-clutter")) {
    EXPECT_EQ(line["contacts_moving"], 0) << line;
    EXPECT_GT(line["least_clearance_m"].get<double>(), 0.0) << line;
  }
}

/// Each was someone with room around, until it was seen from all sides: none of sixteen drives arrived.
TEST(Scenario, tells_lone_posts_from_legs) {
  for (const auto& line : four_drives_of("lone-posts")) EXPECT_EQ(line["contacts_moving"], 0) << line;
}

/// A robot that takes two of them for legs stands before them for good.
TEST(Scenario, takes_no_posts_of_a_heap_for_legs) {
  for (const auto& line : four_drives_of("heaps-of-posts")) EXPECT_EQ(line["contacts_moving"], 0) << line;
}

/// They do not see the robot, and run into it where it stands.
TEST(Scenario, does_not_move_while_somebody_touches_the_robot) {
  for (const auto& line : four_drives_of("crossing-people")) EXPECT_EQ(line["contacts_moving"], 0) << line;
}

}  // namespace
}  // namespace lodestar
