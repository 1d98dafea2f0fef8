#include <fstream>
#include <gmock/gmock.h>
#include <sstream>

#include "tests/architecture/arrows.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const fs::path root = LODESTAR_SOURCE_DIR;

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// All .hpp and .cpp under a folder, as paths from the root.
std::vector<std::string> sources_under(const std::string& folder) {
  std::vector<std::string> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
    const fs::path& path = entry.path();
    if (path.extension() != ".hpp" && path.extension() != ".cpp") continue;
    files.push_back(path.lexically_relative(root).generic_string());
  }
  return files;
}

/// All of our headers that a file includes, directly or through others.
std::set<std::string> reached_from(const std::string& file) {
  std::set<std::string> reached;
  std::vector<std::string> open{file};
  while (!open.empty()) {
    const std::string text = text_of(root / open.back());
    open.pop_back();
    for (const std::string& header : includes_of(text)) {
      if (reached.insert(header).second) open.push_back(header);
    }
  }
  return reached;
}

std::vector<std::string> all_rooms() {
  std::vector<std::string> rooms;
  for (const auto& [room, used] : arrows()) rooms.push_back(room);
  return rooms;
}

class Room : public testing::TestWithParam<std::string> {};

TEST_P(Room, includes_only_along_the_arrows_and_keeps_its_files_short) {
  const std::vector<std::string> sources = sources_under(GetParam());
  EXPECT_TRUE(!sources.empty() || GetParam() == "app/web");
  for (const std::string& file : sources) {
    if (room_of(file) != GetParam()) continue;
    EXPECT_THAT(complaints_about_source(file, text_of(root / file)), IsEmpty());
  }
}

TEST_P(Room, links_only_along_the_arrows) {
  if (GetParam() == "app") return;  // main.cpp: a program, no library
  const std::string cmake = text_of(root / GetParam() / "CMakeLists.txt");
  EXPECT_THAT(complaints_about_target(GetParam(), cmake), IsEmpty());
}

TEST_P(Room, is_not_led_back_to_itself) {
  for (const std::string& used : arrows().at(GetParam()))
    EXPECT_FALSE(usable_by(used).contains(GetParam())) << "through " << used;
}

INSTANTIATE_TEST_SUITE_P(Architecture, Room, testing::ValuesIn(all_rooms()), [](const auto& room) {
  std::string name = room.param;
  std::ranges::replace(name, '/', '_');
  return name;
});

TEST(Rooms, hold_every_source) {
  for (const char* folder : {"maps", "localization", "planning", "control", "drivers", "app"}) {
    for (const std::string& file : sources_under(folder)) EXPECT_FALSE(room_of(file).empty()) << file;
  }
}

TEST(Rooms, leave_nothing_loose_in_app_but_main) {
  for (const std::string& file : sources_under("app"))
    EXPECT_TRUE(room_of(file) != "app" || file == "app/main.cpp") << file;
}

TEST(Arrows, are_read_from_includes_however_they_are_spaced) {
  const std::string source =
      "#pragma once\n#include <vector>\n#include \"maps/frame.hpp\"\n"
      "// #include \"app/site/site.hpp\"\n  #  include \"drivers/camera/camera.hpp\"\n";
  EXPECT_THAT(includes_of(source), ElementsAre("maps/frame.hpp", "drivers/camera/camera.hpp"));
}

TEST(Arrows, between_sisters_and_upwards_are_refused) {
  EXPECT_THAT(complaints_about_source("planning/route.cpp", "#include \"control/drive.hpp\"\n"),
              ElementsAre(HasSubstr("no arrow from planning to control")));
  EXPECT_THAT(complaint_about_include("maps/frame.hpp", "app/site/site.hpp"),
              HasSubstr("no arrow from maps to app/site"));
  EXPECT_THAT(complaint_about_include("planning/route.cpp", "route.hpp"), HasSubstr("full path"));
  EXPECT_THAT(complaint_about_include("planning/route.cpp", "maps/frame.hpp"), IsEmpty());
}

TEST(Arrows, between_rooms_of_one_folder_are_refused_too) {
  EXPECT_THAT(complaint_about_include("app/console/live_view.cpp", "app/viewers/foxglove_hub.hpp"),
              HasSubstr("no arrow from app/console to app/viewers"));
  EXPECT_THAT(complaint_about_include("localization/pose/p3p.cpp", "localization/filter/belief.hpp"),
              HasSubstr("no arrow from localization/pose to localization/filter"));
  EXPECT_THAT(complaint_about_include("drivers/can/candump.cpp", "drivers/base/guard.hpp"),
              HasSubstr("no arrow from drivers/can to drivers/base"));
  EXPECT_THAT(complaint_about_include("app/new_room/thing.cpp", "maps/frame.hpp"), HasSubstr("no room"));
}

TEST(Arrows, lead_on_where_those_that_they_lead_to_lead) {
  EXPECT_THAT(complaint_about_include("app/navigation/navigation.cpp", "planning/route.hpp"), IsEmpty());
  EXPECT_THAT(complaint_about_include("app/drive/run.cpp", "maps/frame.hpp"), IsEmpty());
}

TEST(Arrows, keep_the_simulated_truth_from_all_but_those_that_are_judged) {
  const std::string truth = "drivers/simulation/scoring.hpp";
  for (const char* room : {"navigation", "drive", "live", "recording", "commands", "console", "viewers"}) {
    const std::string file = std::string("app/") + room + "/any.cpp";
    EXPECT_THAT(complaint_about_include(file, truth), Not(IsEmpty())) << file;
  }
  for (const char* room : {"simulate", "report", "campaign", "bench", "hosting"}) {
    const std::string file = std::string("app/") + room + "/any.cpp";
    EXPECT_THAT(complaint_about_include(file, truth), IsEmpty()) << file;
  }
  EXPECT_THAT(complaint_about_include("app/commands/plan.cpp", truth), HasSubstr("judge"));
  EXPECT_THAT(complaint_about_include("drivers/simulation/scoring.cpp", truth), IsEmpty());
}

TEST(Arrows, lead_the_navigator_to_the_hardware_and_not_to_the_simulated_world) {
  for (const char* file : {"app/navigation/navigation.cpp", "app/navigation/mission.cpp",
                           "app/navigation/navigation_setup.cpp", "drivers/base/base_driver.cpp"}) {
    EXPECT_THAT(reached_from(file),
                AllOf(Contains("drivers/can/can_bus.hpp"), Not(Contains(HasSubstr("drivers/simulation")))))
        << file;
  }
}

TEST(Arrows, of_targets_are_refused_too) {
  const std::string good =
      "lodestar_library(control\n  SOURCES a.cpp b.cpp\n  USES lodestar_maps opencv_core)\n";
  const std::string bad =
      "lodestar_library(control\n  SOURCES a.cpp\n  USES lodestar_maps lodestar_planning)\n";
  const std::string hears = "lodestar_library(commands\n  SOURCES a.cpp\n  USES lodestar_simulation)\n";
  EXPECT_THAT(complaints_about_target("control", good), IsEmpty());
  EXPECT_THAT(complaints_about_target("control", bad), ElementsAre(HasSubstr("links planning")));
  EXPECT_THAT(complaints_about_target("control", ""), ElementsAre(HasSubstr("0 libraries")));
  EXPECT_THAT(complaints_about_target("planning", good), ElementsAre(HasSubstr("defines the library")));
  EXPECT_THAT(complaints_about_target("app/commands", hears), ElementsAre(HasSubstr("judge")));
}

TEST(Arrows, long_files_are_refused) {
  const std::string longest(longest_source_lines, '\n');
  EXPECT_THAT(complaints_about_source("maps/frame.hpp", longest), IsEmpty());
  EXPECT_THAT(complaints_about_source("maps/frame.hpp", longest + "\n"), ElementsAre(HasSubstr("351 lines")));
}

}  // namespace
}  // namespace lodestar
