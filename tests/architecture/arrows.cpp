#include "tests/architecture/arrows.hpp"

#include <algorithm>
#include <optional>
#include <regex>

namespace lodestar {
namespace {

/// The simulated world: scoring and ground truth.
const std::string judge = "drivers/simulation";
/// Rooms that may use it, besides drivers/: those that simulate, report and measure.
const std::set<std::string> judged{"app/report", "app/simulate", "app/campaign", "app/bench", "app/hosting"};

/// Folders whose subfolders are rooms.
const std::set<std::string> houses{"app", "drivers", "localization"};

std::string folder_of(const std::string& path) {
  return path.substr(0, path.find('/'));
}

/// The room of a target, whose name is the last part of the room's; nothing for an unknown name.
std::optional<std::string> room_of_target(const std::string& name) {
  for (const auto& [room, used] : arrows())
    if (room.substr(room.find('/') + 1) == name) return room;
  return std::nullopt;
}

}  // namespace

const std::map<std::string, std::set<std::string>>& arrows() {
  static const std::map<std::string, std::set<std::string>> drawn{
      {"maps", {}},
      {"planning", {"maps"}},
      {"control", {"maps"}},

      {"localization/detection", {"maps"}},
      {"localization/ceiling", {"maps"}},
      {"localization/scan", {"maps"}},
      {"localization/pose", {"localization/detection"}},
      {"localization/filter", {"localization/pose", "localization/ceiling"}},
      {"localization/integrity", {"localization/filter"}},
      {"localization/calibration", {"localization/pose"}},
      {"localization/survey", {"localization/pose", "localization/ceiling"}},

      {"drivers/system", {"maps"}},
      {"drivers/can", {"drivers/system"}},
      {"drivers/base", {"drivers/can"}},
      {"drivers/camera", {"drivers/system"}},
      {"drivers/scanner", {"drivers/system"}},
      {"drivers/simulation", {"drivers/base", "drivers/camera", "drivers/scanner"}},
      {"drivers/stand_in", {"drivers/simulation"}},

      {"app/common", {"maps"}},
      {"app/net", {"app/common"}},
      {"app/site", {"app/common", "drivers/base", "planning"}},
      {"app/frames", {"app/common", "drivers/camera", "localization/survey"}},
      {"app/navigation", {"app/site", "control", "localization/integrity", "localization/scan"}},
      {"app/placement", {"app/recording", "app/navigation", "app/frames", "localization/calibration"}},
      {"app/recording", {"app/navigation", "app/common", "localization/survey"}},
      {"app/live", {"app/recording", "app/net"}},
      {"app/fleet", {"app/navigation", "app/live", "app/site", "app/common"}},
      {"app/ros2", {"app/recording", "app/navigation", "app/site", "app/common"}},
      {"app/report", {"app/recording", "app/placement", judge}},
      {"app/simulate", {"app/report", "app/live", "app/navigation", "app/frames", judge}},
      {"app/drive",
       {"app/report", "app/live", "app/navigation", "app/frames", "drivers/stand_in", "drivers/scanner"}},
      {"app/viewers", {"app/report", "app/recording", "app/ros2", "app/live", "app/net"}},
      {"app/web", {}},
      {"app/console", {"app/placement", "app/live", "app/ros2", "app/net", "app/web"}},
      {"app/bench", {"app/report", judge}},
      {"app/campaign", {"app/simulate", judge}},
      {"app/hosting", {"app/site", "app/common", "drivers/scanner", judge}},
      {"app/commands",
       {"app/bench", "app/campaign", "app/console", "app/drive", "app/fleet", "app/hosting", "app/ros2",
        "app/simulate", "app/viewers"}},
      {"app", {"app/commands"}},  // main.cpp alone
  };
  return drawn;
}

std::set<std::string> usable_by(const std::string& room) {
  std::set<std::string> usable{room};
  std::vector<std::string> open{room};
  while (!open.empty()) {
    const std::string from = open.back();
    open.pop_back();
    for (const std::string& to : arrows().at(from))
      if (usable.insert(to).second) open.push_back(to);
  }
  return usable;
}

std::string room_of(const std::string& file) {
  const std::string folder = folder_of(file);
  const std::size_t second = file.find('/', folder.size() + 1);
  const bool is_inside = houses.contains(folder) && second != std::string::npos;
  const std::string room = is_inside ? file.substr(0, second) : folder;
  return arrows().contains(room) ? room : "";
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
  const std::string room = room_of(file);
  const std::string used = room_of(header);
  if (room.empty()) return file + " stands in no room";
  if (used.empty()) return file + " includes " + header + ", not by its full path";
  if (!usable_by(room).contains(used))
    return file + " includes " + header + ": no arrow from " + room + " to " + used;
  if (used == judge && folder_of(room) != "drivers" && !judged.contains(room))
    return file + " includes " + header + ": " + room + " may not hear the judge of the simulated world";
  return {};
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

std::vector<std::string> complaints_about_target(const std::string& room, const std::string& cmake) {
  static const std::regex library{R"(lodestar_library\(\s*(\w+)[^)]*\bUSES\b([^)]*)\))"};
  static const std::regex target{R"(\blodestar_(\w+))"};
  std::vector<std::string> complaints;
  int libraries = 0;
  for (std::sregex_iterator at(cmake.begin(), cmake.end(), library), end; at != end; ++at) {
    ++libraries;
    if (room_of_target((*at)[1]) != room)
      complaints.push_back(room + " defines the library " + (*at)[1].str());
    const std::string uses = (*at)[2];
    for (std::sregex_iterator use(uses.begin(), uses.end(), target); use != end; ++use) {
      if ((*use)[1] == "properties") continue;
      const std::optional<std::string> used = room_of_target((*use)[1]);
      if (!used)
        complaints.push_back(room + "/CMakeLists.txt links " + (*use)[1].str() + ": no such room");
      else if (!usable_by(room).contains(*used))
        complaints.push_back(room + "/CMakeLists.txt links " + *used + ": no such arrow");
      else if (*used == judge && folder_of(room) != "drivers" && !judged.contains(room))
        complaints.push_back(room + "/CMakeLists.txt links the judge of the simulated world");
    }
  }
  if (libraries != 1) complaints.push_back(room + " has " + std::to_string(libraries) + " libraries");
  return complaints;
}

}  // namespace lodestar
