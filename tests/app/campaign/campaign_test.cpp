#include "app/campaign/campaign.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <set>

#include "app/campaign/campaign_report.hpp"
#include "app/campaign/random_doors.hpp"
#include "app/campaign/random_faults.hpp"
#include "app/campaign/random_site.hpp"
#include "app/campaign/random_things.hpp"
#include "app/common/process_health.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "maps/input_error.hpp"
#include "maps/map_overlay.hpp"
#include "planning/margin_planner.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

Site lab() {
  return load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
}

const std::vector<int> ids{447,  1782, 387,  620,  689,  936,  988,  1135, 1178, 1395, 1549, 1849, 1887,
                           2271, 2274, 2357, 2454, 2641, 2826, 2918, 3390, 3501, 3655, 3748, 3987};

int lines_in(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return static_cast<int>(std::count(std::istreambuf_iterator<char>(stream), {}, '\n'));
}

TEST(Campaign, builds_the_same_building_from_the_same_seed) {
  const Site robot = lab();
  const Site first = random_site(robot, ids, 5);
  const Site again = random_site(robot, ids, 5);
  const Site other = random_site(robot, ids, 6);
  EXPECT_EQ(first.map.map.cells, again.map.map.cells);
  EXPECT_EQ(first.start.position_m, again.start.position_m);
  EXPECT_NE(first.map.map.cells, other.map.map.cells);
  std::set<int> seen;
  for (const RegisteredMarker& marker : first.registry.markers) seen.insert(marker.id);
  EXPECT_EQ(seen.size(), first.registry.markers.size()) << "no ID twice";
  EXPECT_GE(first.registry.markers.size(), 6U);
}

/// On an empty map of 8 x 4 m, a wall across it with a gap.
Site two_rooms(double gap_m) {
  Site site = lab();
  OccupancyMap& map = site.map.map;
  map = {.columns = 160, .rows = 80, .resolution_m = 0.05, .map_from_grid = {}, .cells = {}};
  map.cells.assign(160UL * 80UL, OccupancyMap::free);
  for (int row = 0; row < map.rows; ++row)
    if (std::abs(map.center_of({80, row}).y() - 2.0) > 0.5 * gap_m)
      for (const int column : {80, 81}) map.cells[map.index({column, row})] = OccupancyMap::occupied;
  site.start = {{1.5, 2.0}, 0.0};
  site.goals = {{{6.5, 2.0}, 0.0}};
  return site;
}

TEST(Campaign, finds_the_doorway_on_the_way_and_no_other_gap) {
  const std::vector<Doorway> doorways = doorways_of(two_rooms(1.2));
  ASSERT_EQ(doorways.size(), 1U);
  EXPECT_NEAR(doorways[0].from_m.x(), 4.05, 0.1);
  EXPECT_NEAR((doorways[0].to_m - doorways[0].from_m).norm(), 1.2, 0.06);
  EXPECT_THAT(doorways_of(two_rooms(2.4)), ::testing::IsEmpty()) << "as wide as a gate";
}

TEST(Campaign, shuts_a_door_in_half_of_the_worlds_and_opens_it_where_there_is_no_other_way) {
  const Site site = two_rooms(1.2);
  int doors = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const std::optional<SlidingDoor> door = random_door(site, {}, seed);
    if (!door) continue;
    ++doors;
    ASSERT_TRUE(door->opens);
    EXPECT_GT(*door->opens, door->shuts + std::chrono::seconds(4));
    EXPECT_NEAR(std::abs(door->from_m.y() - 2.0), 0.6, 0.06);
    EXPECT_NEAR(std::abs(door->to_m.y() - 2.0), 0.6, 0.06);
  }
  EXPECT_GT(doors, 10);
  EXPECT_LT(doors, 30);
}

TEST(Campaign, puts_no_robot_where_an_open_door_waits) {
  const Site robot = lab();
  int doors = 0;
  for (std::uint64_t number = 520; number < 560; ++number) {
    const CampaignMission mission = mission_of(robot, campaign_ids(), number, {.has_people = true});
    for (const SlidingDoor& door : mission.replay.doors) {
      ++doors;
      const SlidingLeaf open(door);
      for (const DiscState& disc : open.discs())
        EXPECT_GT((disc.position_m - mission.site.start.position_m).norm(),
                  robot.robot.radius_m + disc.radius_m)
            << number;
    }
  }
  EXPECT_GT(doors, 10);
}

TEST(Campaign, leaves_a_door_shut_only_where_things_leave_another_way) {
  Site site = two_rooms(1.2);
  OccupancyMap& map = site.map.map;
  for (int row = 0; row < map.rows; ++row)
    if (std::abs(map.center_of({80, row}).y() - 0.7) < 0.45)
      for (const int column : {80, 81}) map.cells[map.index({column, row})] = OccupancyMap::free;
  const MovingDisc box{.radius_m = 0.3, .trajectory = {.keys = {{Duration::zero(), Vec2(4.05, 0.7)}}}};
  int stay = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const std::optional<SlidingDoor> door = random_door(site, {}, seed);
    if (!door) continue;
    stay += door->opens ? 0 : 1;
    EXPECT_TRUE(random_door(site, {&box, 1}, seed)->opens) << seed;
  }
  EXPECT_GT(stay, 3);
}

TEST(Campaign, puts_things_in_the_way_that_leave_one) {
  const Site robot = lab();
  int things = 0;
  int pushed = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Site site = random_site(robot, ids, seed);
    const std::vector<MovingDisc> drawn = random_things(site, seed);
    const std::vector<MovingDisc> again = random_things(site, seed);
    ASSERT_EQ(drawn.size(), again.size());
    OccupancyMap map = site.map.map;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      const Vec2 stands_m = drawn[i].trajectory.keys.back().position_m;
      EXPECT_EQ(stands_m, again[i].trajectory.keys.back().position_m);
      EXPECT_GE((stands_m - site.start.position_m).norm(), 1.0 + drawn[i].radius_m + site.robot.radius_m);
      const Vec2 points_m[]{stands_m, stands_m + Vec2(drawn[i].radius_m, 0.0)};
      map = overlaid(map, points_m);
      ++things;
      pushed += drawn[i].trajectory.keys.size() > 1 ? 1 : 0;
    }
    const MarginPlanner planner(map, navigation_options(site.robot).planner);
    EXPECT_TRUE(
        std::holds_alternative<Plan>(planner.plan(site.start.position_m, site.goals.front().position_m)));
  }
  EXPECT_GT(things, 10);
  EXPECT_GT(pushed, 2);
  EXPECT_LT(pushed, things);
}

TEST(Campaign, without_faults_has_none_and_a_true_registry) {
  for (std::uint64_t number = 1; number <= 30; ++number) {
    const CampaignMission mission = mission_of(lab(), ids, number, {.has_people = true, .has_faults = false});
    EXPECT_TRUE(mission.replay.faults.empty());
    EXPECT_EQ(mission.replay.disturbances.misplaced_m, 0.0);
    EXPECT_GE(mission.replay.people.count, 1);
  }
}

TEST(Campaign, draws_faults_of_every_kind) {
  const auto drawn = [](bool has_scanner) {
    std::set<FaultKind> kinds;
    for (std::uint64_t seed = 1; seed <= 600; ++seed)
      for (const Fault& fault : random_faults(seed, has_scanner)) kinds.insert(fault.kind);
    return kinds;
  };
  EXPECT_EQ(drawn(true).size(), all_fault_kinds().size() - 2) << "all but those of the disk";
  EXPECT_EQ(std::ranges::count_if(drawn(false), concerns_scanner), 0);
  EXPECT_EQ(static_cast<std::ptrdiff_t>(drawn(false).size()),
            std::ranges::count_if(drawn(true), std::not_fn(concerns_scanner)));
}

TEST(Campaign, misleads_no_robot_that_has_seen_nothing_yet) {
  using enum FaultKind;
  const std::set<FaultKind> misleading{marker_moved, marker_wrong_id, markers_swapped, marker_duplicated};
  int together = 0;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    const std::vector<Fault> faults = random_faults(seed, false);
    const auto dark = std::ranges::find_if(faults, [](const Fault& fault) {
      return (fault.kind == camera_dropped || fault.kind == camera_black) && fault.begin == Duration::zero();
    });
    if (dark == faults.end()) continue;
    for (const Fault& fault : faults) {
      if (!misleading.contains(fault.kind)) continue;
      ++together;
      ASSERT_TRUE(dark->lasts) << seed;
      EXPECT_GT(fault.begin, *dark->lasts + std::chrono::seconds(1)) << seed;
    }
  }
  EXPECT_GT(together, 0);
}

// 6692: a wheel slips just before a gap of 55 cm. 8476: a robot with a blurred camera learns its wheel scales
// from one frame in twenty seconds.
TEST(Campaign, touches_nothing_in_missions_that_once_did) {
  const TemporaryFolder folder;
  for (const auto& [mission, fault] : {std::pair{6692U, "wheel_slip"}, std::pair{8476U, "camera_blurred"}}) {
    const auto outcomes = run_campaign(lab(), {.first = mission, .missions = 1},
                                       folder / std::to_string(mission), [](double) {});
    ASSERT_EQ(outcomes.size(), 1U);
    EXPECT_THAT(outcomes.front().faults, testing::Contains(fault));
    EXPECT_EQ(outcomes.front().contacts, 0) << mission;
  }
}

TEST(Campaign, goes_on_where_it_was_cut_off) {
  const TemporaryFolder folder;
  const Site robot = lab();
  const auto nothing = [](double) {};
  const auto whole = run_campaign(robot, {.first = 4, .missions = 3}, folder / "whole", nothing);
  run_campaign(robot, {.first = 4, .missions = 1}, folder / "cut", nothing);
  std::ofstream(folder / "cut" / "missions.jsonl", std::ios::app) << R"({"mission": 5, "fau)" << "\n";
  const auto resumed =
      run_campaign(robot, {.first = 4, .missions = 3, .resume = true}, folder / "cut", nothing);
  EXPECT_EQ(campaign_json(whole).dump(), campaign_json(resumed).dump());
  EXPECT_EQ(lines_in(folder / "cut" / "missions.jsonl"), 4) << "one of them truncated, no mission twice";
}

TEST(Campaign, takes_no_missions_of_something_else) {
  const TemporaryFolder folder;
  const nlohmann::json mission = as_json(MissionOutcome{.mission = 4});
  const auto with = [&](const char* key, const nlohmann::json& value) {
    nlohmann::json changed = mission;
    changed[key] = value;
    return changed;
  };
  for (const nlohmann::json& line :
       {nlohmann::json(7), with("mission", -1), with("mission", 1e30), with("contacts", 1e30),
        with("faults", "none"), with("arrived", nullptr)}) {
    folder.write("missions.jsonl", mission.dump() + "\n" + line.dump() + "\n");
    try {
      run_campaign(lab(), {.first = 4, .missions = 1, .resume = true}, folder / "", [](double) {});
      ADD_FAILURE() << line;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("missions.jsonl:2: found"));
    }
  }
}

TEST(Campaign, reports_contacts_with_people_where_they_walk_about) {
  const MissionOutcome met{
      .mission = 5,
      .arrived = true,
      .people = PeopleContacts{.moving = 1, .excused = 2, .at_rest = 3, .greatest_mps = 0.5}};
  EXPECT_TRUE(met.hit_something()) << "a person, while it moved";
  const MissionOutcome stood{.mission = 6, .arrived = true, .people = PeopleContacts{.at_rest = 1}};
  EXPECT_FALSE(stood.hit_something());
  EXPECT_EQ(as_json(outcome_from(as_json(met))).dump(), as_json(met).dump());
  const auto report = campaign_json({met, stood});
  EXPECT_EQ(report["all"]["people"]["moving"], 1);
  EXPECT_EQ(report["all"]["people"]["at_rest"], 4);
  EXPECT_EQ(report["failures"][0]["repeat"], "lodestar campaign --mission 5 --people");
  EXPECT_NE(campaign_html({met}).find("Contacts with people"), std::string::npos);
  EXPECT_NE(campaign_html({met}).find("contact with people or things"), std::string::npos) << "not the map";
  EXPECT_EQ(campaign_html({MissionOutcome{.mission = 1}}).find("Contacts with people"), std::string::npos);
}

TEST(Campaign, reports_contacts_and_silently_wrong_arrivals_with_the_command_that_repeats_them) {
  const MissionOutcome fine{.mission = 1, .faults = {"can_loss"}, .arrived = true, .error_m = 0.01};
  const MissionOutcome hit{.mission = 2, .faults = {"wheel_slip"}, .failure = "stuck", .contacts = 3};
  const MissionOutcome wrong{.mission = 3, .faults = {}, .arrived = true, .error_m = 0.2};
  const MissionOutcome stopped{
      .mission = 4, .faults = {"can_loss"}, .failure = "the base is silent", .noticed_after_s = 0.1};
  const MissionOutcome excused{
      .mission = 5, .faults = {"kidnapping"}, .failure = "stuck", .contacts = 3, .excuse = "put down blind"};
  const auto report = campaign_json({fine, hit, wrong, stopped, excused});
  EXPECT_EQ(report["all"]["missions"], 5);
  EXPECT_EQ(report["all"]["excused"], 1);
  EXPECT_EQ(report["excused"][0]["repeat"], "lodestar campaign --mission 5");
  EXPECT_NE(campaign_html({excused}).find("excused contact, put down blind"), std::string::npos);
  EXPECT_EQ(as_json(outcome_from(as_json(excused))).dump(), as_json(excused).dump());
  EXPECT_EQ(report["all"]["arrivals"], 1);
  EXPECT_EQ(report["all"]["safe_stops"], 1);
  EXPECT_EQ(report["all"]["contacts"], 1);
  EXPECT_EQ(report["all"]["silently_wrong"], 1);
  EXPECT_EQ(report["by_fault"]["can_loss"]["missions"], 2);
  ASSERT_EQ(report["failures"].size(), 2U);
  EXPECT_EQ(report["failures"][0]["repeat"], "lodestar campaign --mission 2");
  EXPECT_NE(campaign_html({fine, hit}).find("campaign --mission 2"), std::string::npos);
  EXPECT_EQ(as_json(outcome_from(as_json(stopped))).dump(), as_json(stopped).dump());
}

TEST(TimeHistogram, knows_quantiles_to_three_percent) {
  TimeHistogram histogram;
  EXPECT_FALSE(histogram.quantile_ms(0.5));
  for (int us = 1; us <= 10'000; ++us) histogram.add(std::chrono::microseconds(us));
  EXPECT_EQ(histogram.count(), 10'000U);
  EXPECT_NEAR(histogram.quantile_ms(0.5).value(), 5.0, 0.15);
  EXPECT_NEAR(histogram.quantile_ms(0.999).value(), 9.99, 0.3);
  EXPECT_DOUBLE_EQ(histogram.max_ms(), 10.0);
}

TEST(ProcessHealth, sees_memory_and_descriptors) {
  const ProcessHealth before = process_health();
  EXPECT_GT(before.resident_kb, 1000);
  const std::ifstream one_more("/proc/self/status");
  EXPECT_EQ(process_health().descriptors, before.descriptors + 1);
}

}  // namespace
}  // namespace lodestar
