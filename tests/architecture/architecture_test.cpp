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

/// All headers of ours that a file includes, directly or through others.
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

class Folder : public testing::TestWithParam<std::string> {};

TEST_P(Folder, IncludesOnlyAlongTheArrowsAndKeepsItsFilesShort) {
  const std::vector<std::string> sources = sources_under(GetParam());
  ASSERT_FALSE(sources.empty());
  for (const std::string& file : sources) {
    EXPECT_THAT(complaints_about_source(file, text_of(root / file)), IsEmpty());
  }
}

TEST_P(Folder, LinksOnlyAlongTheArrows) {
  const std::string cmake = text_of(root / GetParam() / "CMakeLists.txt");
  EXPECT_THAT(complaints_about_targets(GetParam(), cmake), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Architecture, Folder,
                         testing::Values("maps", "localization", "planning", "control", "drivers", "app"),
                         [](const auto& folder) { return folder.param; });

TEST(Arrows, AreReadFromIncludesHoweverTheyAreSpaced) {
  const std::string source =
      "#pragma once\n#include <vector>\n#include \"maps/frame.hpp\"\n"
      "// #include \"app/site.hpp\"\n  #  include \"drivers/camera.hpp\"\n";
  EXPECT_THAT(includes_of(source), ElementsAre("maps/frame.hpp", "drivers/camera.hpp"));
}

TEST(Arrows, BetweenSistersAndUpwardsAreRefused) {
  EXPECT_THAT(complaints_about_source("planning/route.cpp", "#include \"control/drive.hpp\"\n"),
              ElementsAre(HasSubstr("no arrow from planning to control")));
  EXPECT_THAT(complaint_about_include("maps/frame.hpp", "app/site.hpp"),
              HasSubstr("no arrow from maps to app"));
  EXPECT_THAT(complaint_about_include("planning/route.cpp", "route.hpp"), HasSubstr("full path"));
  EXPECT_THAT(complaint_about_include("planning/route.cpp", "maps/frame.hpp"), IsEmpty());
  EXPECT_THAT(complaint_about_include("app/navigation.cpp", "planning/route.hpp"), IsEmpty());
}

TEST(Arrows, KeepTheSimulatedTruthFromTheNavigator) {
  EXPECT_THAT(complaint_about_include("app/replay.cpp", "drivers/simulated_motion.hpp"),
              HasSubstr("not meant for outside"));
  EXPECT_THAT(complaint_about_include("app/navigation.cpp", "drivers/simulation.hpp"), HasSubstr("judged"));
  EXPECT_THAT(complaint_about_include("app/commands/plan.cpp", "drivers/scoring.hpp"), HasSubstr("judged"));
  EXPECT_THAT(complaint_about_include("app/replay.cpp", "drivers/simulation.hpp"), IsEmpty());
  EXPECT_THAT(complaint_about_include("drivers/scoring.cpp", "drivers/simulated_motion.hpp"), IsEmpty());
}

TEST(Arrows, LeadTheNavigatorToTheHardwareAndNotToTheSimulatedWorld) {
  for (const char* file :
       {"app/navigation.cpp", "app/mission.cpp", "app/navigation_setup.cpp", "drivers/base_driver.cpp"}) {
    EXPECT_THAT(reached_from(file),
                AllOf(Contains("drivers/can_bus.hpp"), Not(Contains(HasSubstr("drivers/simul"))),
                      Not(Contains("drivers/scoring.hpp"))))
        << file;
  }
}

TEST(Arrows, OfTargetsAreRefusedToo) {
  const std::string good =
      "lodestar_library(control\n  SOURCES a.cpp b.cpp\n  USES lodestar_maps opencv_core)\n";
  const std::string bad =
      "lodestar_library(control\n  SOURCES a.cpp\n  USES lodestar_maps lodestar_planning)\n";
  EXPECT_THAT(complaints_about_targets("control", good), IsEmpty());
  EXPECT_THAT(complaints_about_targets("control", bad), ElementsAre(HasSubstr("links planning")));
  EXPECT_THAT(complaints_about_targets("control", ""), ElementsAre(HasSubstr("0 libraries")));
}

TEST(Arrows, LongFilesAreRefused) {
  const std::string longest(longest_source_lines, '\n');
  EXPECT_THAT(complaints_about_source("maps/frame.hpp", longest), IsEmpty());
  EXPECT_THAT(complaints_about_source("maps/frame.hpp", longest + "\n"), ElementsAre(HasSubstr("351 lines")));
}

}  // namespace
}  // namespace lodestar
