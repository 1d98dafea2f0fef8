#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/scenarios/command_line.hpp"

namespace lodestar {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string lab = std::string("plan --map ") + LODESTAR_SOURCE_DIR + "/sites/lab/map.yaml ";

class PlanWith : public ::testing::TestWithParam<std::string> {};

TEST_P(PlanWith, gives_the_agreed_json) {
  const ScratchFolder scratch;
  const Ran ran = run_lodestar(
      lab + "--start 1.2,5.6 --goal 4.0,4.4 --format json --iterations 500 --planner " + GetParam(),
      scratch.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const auto plan = nlohmann::ordered_json::parse(ran.out);
  std::vector<std::string> keys;
  for (const auto& [key, value] : plan.items()) keys.push_back(key);
  EXPECT_THAT(keys, ElementsAre("status", "planner", "length_m", "turns", "travel_time_s", "plan_us",
                                "expanded", "prepare_us", "waypoints"));
  EXPECT_GT(plan["prepare_us"].get<double>(), 0.0);
  EXPECT_EQ(plan["status"], "ok");
  EXPECT_EQ(plan["planner"], GetParam());
  EXPECT_EQ(plan["waypoints"].size(), plan["turns"].get<std::size_t>() + 2);
  EXPECT_EQ(plan["waypoints"].front(), (nlohmann::ordered_json{1.2, 5.6}));
}

INSTANTIATE_TEST_SUITE_P(Planners, PlanWith,
                         ::testing::Values("fastest", "anyangle", "astar", "rrtstar", "informedrrtstar",
                                           "bitstar", "abitstar", "prmstar"),
                         [](const auto& planner) { return planner.param; });

TEST(Plan, counts_the_turns_to_the_headings_that_are_asked_for) {
  const ScratchFolder scratch;
  const auto seconds = [&](const std::string& start) {
    const Ran ran = run_lodestar(lab + "--format json --goal 4.0,4.4 --start " + start, scratch.path());
    return nlohmann::ordered_json::parse(ran.out)["travel_time_s"].get<double>();
  };
  EXPECT_GT(seconds("1.2,5.6,180"), seconds("1.2,5.6") + 1.0);
}

const std::string sites_lab = std::string(LODESTAR_SOURCE_DIR) + "/sites/lab/";
const std::string seen_from_lab = "--start 1.2,5.6 --goal 13.9,2.0 --markers " + sites_lab +
                                  "markers.yaml --camera " + sites_lab + "camera.yaml --mount " + sites_lab +
                                  "robot.yaml ";

TEST(Plan, goes_a_longer_way_to_keep_the_pose_sure) {
  const ScratchFolder scratch;
  const auto length_m = [&](const std::string& options) {
    const Ran ran =
        run_lodestar(lab + seen_from_lab + "--planner anyangle --format json " + options, scratch.path());
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    return nlohmann::ordered_json::parse(ran.out)["length_m"].get<double>();
  };
  EXPECT_GT(length_m("--max-sigma 0.02 --draw sure.png"), length_m("") + 0.3);
  EXPECT_TRUE(std::filesystem::exists(scratch.path() / "sure.png"));
  EXPECT_EQ(length_m("--keep-markers 1 --blind-way 50"), length_m("")) << "a limit that costs nothing";
}

TEST(Plan, says_that_no_way_keeps_the_pose_sure) {
  const ScratchFolder scratch;
  const Ran ran = run_lodestar(lab + seen_from_lab + "--format json --keep-markers 2", scratch.path());
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_EQ(nlohmann::ordered_json::parse(ran.out)["status"], "no path on which the pose stays sure enough");
}

TEST(Plan, wants_to_know_what_is_in_view_before_it_can_keep_it_there) {
  const ScratchFolder scratch;
  const Ran ran =
      run_lodestar(lab + "--start 1.2,5.6 --goal 4.0,4.4 --keep-markers 1 --markers m", scratch.path());
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_THAT(ran.err, HasSubstr("--camera"));
}

TEST(Plan, offers_the_nearest_place_that_can_be_reached_but_does_not_go_there) {
  const ScratchFolder scratch;
  const Ran ran = run_lodestar(lab + "--start 1.2,5.6 --goal 0.05,0.05 --format json", scratch.path());
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("the nearest place that can be reached is"));
  const auto plan = nlohmann::ordered_json::parse(ran.out);
  EXPECT_EQ(plan["status"], "goal occupied");
  EXPECT_TRUE(plan["waypoints"].empty());
}

}  // namespace
}  // namespace lodestar
