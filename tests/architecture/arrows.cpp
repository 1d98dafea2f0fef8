#include "tests/architecture/arrows.hpp"

#include <algorithm>
#include <regex>

namespace lodestar {
namespace {

/// What app/ may include from drivers/: the face of the hardware by everyone, the simulated world and its
/// judge by those parts that replay, report and measure. All else in drivers/ is its own affair.
const std::set<std::string> face_of_the_hardware{
    "drivers/base_driver.hpp",      "drivers/base_protocol.hpp", "drivers/camera.hpp",
    "drivers/can_bus.hpp",          "drivers/can_interface.hpp", "drivers/candump.hpp",
    "drivers/camera_stand_in.hpp",  "drivers/clock.hpp",         "drivers/guard.hpp",
    "drivers/pluggable_camera.hpp", "drivers/recorded_bus.hpp",  "drivers/socketcan_bus.hpp",
    "drivers/v4l2_camera.hpp"};
const std::set<std::string> simulated_world{"drivers/fault.hpp",          "drivers/fault_file.hpp",
                                            "drivers/hosted_base.hpp",    "drivers/image_former.hpp",
                                            "drivers/printed_square.hpp", "drivers/scoring.hpp",
                                            "drivers/simulated_disk.hpp", "drivers/simulation.hpp"};
const std::regex friends_of_the_judge{
    "app/(replay|hardships|campaign|run_|report|figure|bench|commands/base).*"};

std::string folder_of(const std::string& path) {
  return path.substr(0, path.find('/'));
}

}  // namespace

const std::map<std::string, std::set<std::string>>& allowed_arrows() {
  static const std::map<std::string, std::set<std::string>> arrows{
      {"maps", {"maps"}},
      {"localization", {"localization", "maps"}},
      {"planning", {"planning", "maps"}},
      {"control", {"control", "maps"}},
      {"drivers", {"drivers", "maps"}},
      {"app", {"app", "maps", "localization", "planning", "control", "drivers"}},
  };
  return arrows;
}

std::vector<std::string> includes_of(std::string_view source) {
  static const std::regex include{R"re(^[ \t]*#[ \t]*include[ \t]*"([^"]*)")re",
                                  std::regex::ECMAScript | std::regex::multiline};
  std::vector<std::string> headers;
  for (std::cregex_iterator at(source.data(), source.data() + source.size(), include), end; at != end; ++at) {
    headers.push_back((*at)[1]);
  }
  return headers;
}

std::string complaint_about_include(const std::string& file, const std::string& header) {
  const std::string folder = folder_of(file);
  const std::string used = folder_of(header);
  if (!allowed_arrows().contains(used)) return file + " includes " + header + ", not by its full path";
  if (!allowed_arrows().at(folder).contains(used)) {
    return file + " includes " + header + ": no arrow from " + folder + " to " + used;
  }
  if (used != "drivers" || folder == "drivers" || face_of_the_hardware.contains(header)) return {};
  if (!simulated_world.contains(header))
    return file + " includes " + header + ": not meant for outside of drivers";
  if (std::regex_match(file, friends_of_the_judge)) return {};
  return file + " includes " + header + ": only replays, reports and benches are judged";
}

std::vector<std::string> complaints_about_source(const std::string& file, std::string_view source) {
  std::vector<std::string> complaints;
  for (const std::string& header : includes_of(source)) {
    const std::string complaint = complaint_about_include(file, header);
    if (!complaint.empty()) complaints.push_back(complaint);
  }
  const auto lines = std::ranges::count(source, '\n');
  if (lines > longest_source_lines) complaints.push_back(file + " has " + std::to_string(lines) + " lines");
  return complaints;
}

std::vector<std::string> complaints_about_targets(const std::string& folder, const std::string& cmake) {
  static const std::regex library{R"(lodestar_library\(\s*(\w+)[^)]*\bUSES\b([^)]*)\))"};
  static const std::regex target{R"(\blodestar_(\w+))"};
  std::vector<std::string> complaints;
  int libraries = 0;
  for (std::sregex_iterator at(cmake.begin(), cmake.end(), library), end; at != end; ++at) {
    ++libraries;
    if ((*at)[1] != folder) complaints.push_back(folder + " defines the library " + (*at)[1].str());
    const std::string uses = (*at)[2];
    for (std::sregex_iterator use(uses.begin(), uses.end(), target); use != end; ++use) {
      const std::string used = (*use)[1];
      if (allowed_arrows().at(folder).contains(used)) continue;
      complaints.push_back(folder + "/CMakeLists.txt links " + used + ": no such arrow");
    }
  }
  if (libraries != 1) complaints.push_back(folder + " has " + std::to_string(libraries) + " libraries");
  return complaints;
}

}  // namespace lodestar
