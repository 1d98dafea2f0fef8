#include "app/console/run_archive.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "app/common/rounding.hpp"
#include "app/console/map_json.hpp"
#include "app/console/registry_json.hpp"
#include "app/console/run_facts.hpp"
#include "app/recording/run_origin.hpp"
#include "maps/file_text.hpp"
#include "maps/geometry.hpp"
#include "maps/input_error.hpp"
#include "maps/map_file.hpp"
#include "maps/path_kind.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::size_t most_rows = 20'000;

bool is_run(const fs::directory_entry& entry) {
  return !entry.is_symlink() && entry.is_directory() &&
         (is_complete(entry.path()) || is_file(entry.path() / "run.yaml"));
}

/// Names of a run's pictures, in the order of their stamps. Files of more than 4 MiB are ignored.
std::vector<std::string> pictures_in(const fs::path& folder) {
  constexpr std::uintmax_t most_bytes = 4U << 20U;
  std::vector<std::string> names;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / "pictures", none)) {
    const bool is_picture = !entry.is_symlink() && entry.is_regular_file() &&
                            entry.path().extension() == ".jpg" && entry.file_size(none) <= most_bytes;
    if (is_picture) names.push_back(entry.path().filename().string());
  }
  std::ranges::sort(names, {}, [](const std::string& name) { return std::strtod(name.c_str(), nullptr); });
  return names;
}

/// The stride that keeps at most `most` of the lines.
std::size_t stride_of(const std::string& text, std::size_t most) {
  const auto lines = static_cast<std::size_t>(std::ranges::count(text, '\n')) + 1;
  return (lines + most - 1) / most;
}

}  // namespace

ordered_json trajectory_json(const std::string& tum, const fs::path& file, std::size_t most) {
  const std::size_t stride = stride_of(tum, most);
  ordered_json rows = ordered_json::array();
  std::istringstream stream(tum);
  int line = 0;
  for (std::string text; std::getline(stream, text);) {
    ++line;
    if (text.empty() || text.front() == '#' || static_cast<std::size_t>(line) % stride != 0) continue;
    std::istringstream words(text);
    std::array<double, 8> v{};  // stamp, position, quaternion x y z w
    for (double& value : v) words >> value;
    if (!words) throw InputError(file, line, "'" + text.substr(0, 80) + "'", "eight numbers");
    const double yaw_rad =
        std::atan2(2.0 * (v[7] * v[6] + v[4] * v[5]), 1.0 - 2.0 * (v[5] * v[5] + v[6] * v[6]));
    rows.push_back(
        {rounded(v[0], 1e4), rounded(v[1], 1e5), rounded(v[2], 1e5), rounded(degrees(yaw_rad), 1e3)});
  }
  return rows;
}

ordered_json numbers_json(const std::string& csv, const fs::path& file, std::size_t most) {
  const std::size_t stride = stride_of(csv, most);
  ordered_json rows = ordered_json::array();
  std::istringstream stream(csv);
  std::string text;
  std::getline(stream, text);  // the head
  for (int line = 2; std::getline(stream, text); ++line) {
    if (text.empty() || static_cast<std::size_t>(line) % stride != 0) continue;
    ordered_json row = ordered_json::array();
    std::istringstream words(text);
    char comma = ',';  // or a plus, between IDs
    for (double value = 0.0; (comma == ',' || comma == '+') && words >> value; words >> comma)
      row.push_back(value);
    if (row.empty()) throw InputError(file, line, "'" + text.substr(0, 80) + "'", "numbers");
    rows.push_back(row);
  }
  return rows;
}

namespace {

/// The content of RunArchive::run() of a run that is complete.
ordered_json run_in(const fs::path& folder) {
  ordered_json run{{"name", folder.filename().string()},
                   {"started", nullptr},
                   {"summary", summary_of_run(folder / "summary.json")}};
  if (const std::optional<RunOrigin> origin = origin_if_any(folder)) run["started"] = origin->started;
  const bool has_site = is_file(folder / map_of_run) && is_file(folder / markers_of_run);
  run["map"] = has_site ? map_json(load_map(folder / map_of_run).map) : ordered_json(nullptr);
  run["registry"] = has_site ? registry_json(load_registry(folder / markers_of_run)) : ordered_json(nullptr);
  const auto add = [&](const char* which, const char* extension, auto read) {
    const fs::path file = folder / (std::string(which) + extension);
    run[which] =
        fs::is_regular_file(file) ? read(file_text(file, "a table"), file, most_rows) : ordered_json::array();
  };
  add("estimate", ".tum", trajectory_json);
  add("truth", ".tum", trajectory_json);
  add("steps", ".csv", numbers_json);
  add("fixes", ".csv", numbers_json);
  run["pictures"] = pictures_in(folder);
  return run;
}

}  // namespace

std::vector<std::string> RunArchive::names() const {
  std::vector<std::pair<fs::file_time_type, std::string>> runs;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, none)) {
    if (!is_run(entry)) continue;
    const fs::path newest = entry.path() / (is_complete(entry.path()) ? "summary.json" : "run.yaml");
    runs.emplace_back(fs::last_write_time(newest, none), entry.path().filename().string());
  }
  std::ranges::sort(runs);
  std::vector<std::string> names;
  for (auto& [written, name] : runs) names.push_back(std::move(name));
  return names;
}

RunArchive::Known& RunArchive::known(const std::string& name) const {
  const fs::path folder = folder_ / name;
  std::error_code none;
  const fs::file_time_type written = fs::last_write_time(folder / "summary.json", none);
  const auto found = known_.find(name);
  if (found != known_.end() && found->second.is_complete && found->second.written == written)
    return found->second;
  Known fresh{.written = written,
              .is_complete = is_complete(folder),
              .facts = {{"name", name}},
              .heat = std::nullopt};
  try {
    fresh.facts = facts_of_run(folder);
  } catch (const InputError& error) {
    fresh.facts["why"] = error.what();
  } catch (const nlohmann::json::exception& error) {
    fresh.facts["why"] = error.what();
  }
  return known_.insert_or_assign(name, std::move(fresh)).first->second;
}

ordered_json RunArchive::list() const {
  ordered_json runs = ordered_json::array();
  const std::vector<std::string> present = names();
  for (const std::string& name : present) runs.push_back(known(name).facts);
  std::erase_if(known_,
                [&](const auto& item) { return std::ranges::find(present, item.first) == present.end(); });
  return runs;
}

ordered_json RunArchive::heat(const std::string& site) const {
  constexpr std::size_t most_runs = 50;
  RunHeat all;
  std::size_t runs = 0;
  std::vector<std::string> newest = names();
  std::ranges::reverse(newest);
  for (const std::string& name : newest) {
    Known& one = known(name);
    if (!one.facts.contains("site") || one.facts["site"] != site || !is_complete(folder_ / name)) continue;
    if (runs == most_runs) break;
    try {
      if (!one.heat) one.heat.emplace().add(run_in(folder_ / name));
    } catch (const std::exception&) {
      one.heat.emplace();  // a run that cannot be read says nothing; opening it says why
    }
    all.add(*one.heat);
    ++runs;
  }
  ordered_json heat = all.json();
  heat["runs"] = runs;
  return heat;
}

std::optional<fs::path> RunArchive::folder_of(const std::string& name) const {
  const std::vector<std::string> all = names();
  const auto found = std::ranges::find(all, name);
  if (found == all.end() || !is_complete(folder_ / *found)) return std::nullopt;
  return folder_ / *found;
}

std::optional<ordered_json> RunArchive::run(const std::string& name) const {
  const std::optional<fs::path> folder = folder_of(name);
  return folder ? std::optional(run_in(*folder)) : std::nullopt;
}

std::optional<std::string> RunArchive::cells(const std::string& name) const {
  const std::optional<fs::path> folder = folder_of(name);
  if (!folder || !is_file(*folder / map_of_run)) return std::nullopt;
  const OccupancyMap map = load_map(*folder / map_of_run).map;
  return std::string(map.cells.begin(), map.cells.end());
}

std::optional<std::string> RunArchive::picture(const std::string& name, const std::string& picture) const {
  const std::optional<fs::path> folder = folder_of(name);
  if (!folder) return std::nullopt;
  const std::vector<std::string> all = pictures_in(*folder);
  const auto found = std::ranges::find(all, picture);
  if (found == all.end()) return std::nullopt;
  return file_text(*folder / "pictures" / *found, "a picture");
}

}  // namespace lodestar
