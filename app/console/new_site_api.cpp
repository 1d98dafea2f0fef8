#include "app/console/new_site_api.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>
#include <unistd.h>

#include "app/common/base64.hpp"
#include "app/common/json_parse.hpp"
#include "app/common/json_text.hpp"
#include "app/console/page_file.hpp"
#include "app/console/run_archive.hpp"
#include "app/console/run_facts.hpp"
#include "app/placement/fill.hpp"
#include "app/placement/map_from_runs.hpp"
#include "app/placement/site_floor.hpp"
#include "app/site/site.hpp"
#include "maps/atomic_file.hpp"
#include "maps/input_error.hpp"
#include "maps/picture.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using nlohmann::ordered_json;

/// A file with these bytes while it lives: the readers of plans read files.
class PassingFile {
 public:
  PassingFile(const std::string& ending, const std::string& bytes) {
    std::string folder = (fs::temp_directory_path() / "lodestar-plan-XXXXXX").string();
    if (::mkdtemp(folder.data()) == nullptr)
      throw InputError(folder, 0, "no place to write", "one for the plan");
    folder_ = folder;
    write_file_atomically(file_ = folder_ / ("plan" + ending), bytes);
  }
  ~PassingFile() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  PassingFile(const PassingFile&) = delete;
  PassingFile& operator=(const PassingFile&) = delete;

  [[nodiscard]] const fs::path& path() const { return file_; }

 private:
  fs::path folder_;
  fs::path file_;
};

double number_in(const json& sent, const char* key, double low, double high) {
  const json& value = sent.contains(key) ? sent.at(key) : json();
  if (!value.is_number() || !(value.get<double>() >= low && value.get<double>() <= high))
    throw InputError(fmt::format("{}: found {}, wanted a number from {} to {}", key,
                                 value.dump().substr(0, 40), low, high));
  return value.get<double>();
}

std::string bytes_in(const json& sent, const char* key) {
  std::optional<std::string> bytes = from_base64(sent.at(key).get_ref<const std::string&>());
  if (!bytes) throw InputError(fmt::format("{}: found no base64, wanted it", key));
  return std::move(*bytes);
}

std::string word_in(const json& sent, const char* key, std::initializer_list<const char*> known) {
  const auto word = sent.at(key).get<std::string>();
  if (std::ranges::find(known, word) == known.end())
    throw InputError(fmt::format("{}: found '{}', wanted {}", key, word, fmt::join(known, " or ")));
  return word;
}

ordered_json map_with_cells_json(const OccupancyMap& map) {
  return {{"columns", map.columns},
          {"rows", map.rows},
          {"resolution_m", map.resolution_m},
          {"x_m", map.map_from_grid.position_m.x()},
          {"y_m", map.map_from_grid.position_m.y()},
          {"cells", base64({reinterpret_cast<const char*>(map.cells.data()), map.cells.size()})}};
}

OccupancyMap map_from(const json& sent) {
  constexpr double most_cells_a_side = 20'000.0;
  OccupancyMap map{.columns = static_cast<int>(number_in(sent, "columns", 1.0, most_cells_a_side)),
                   .rows = static_cast<int>(number_in(sent, "rows", 1.0, most_cells_a_side)),
                   .resolution_m = number_in(sent, "resolution_m", 0.005, 1.0)};
  map.map_from_grid.position_m = {number_in(sent, "x_m", -far_m, far_m),
                                  number_in(sent, "y_m", -far_m, far_m)};
  const std::string cells = bytes_in(sent, "cells");
  const auto wanted = static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows);
  if (cells.size() != wanted)
    throw InputError(fmt::format("cells: found {}, wanted {}", cells.size(), wanted));
  for (const char cell : cells) {
    const auto value = static_cast<std::int8_t>(cell);
    if (value != OccupancyMap::free && value != OccupancyMap::occupied && value != OccupancyMap::unknown)
      throw InputError(fmt::format("cells: found {}, wanted 0, 100 or 255", static_cast<int>(value)));
    map.cells.push_back(value);
  }
  return map;
}

/// Of markers at the ceiling, wherever the robot can be.
Filling filled(const fs::path& folder, double ceiling_m) {
  const Site site = load_site(folder);
  Filling filling = fill_gaps(site.registry, covered_floor(site), {.ceiling_m = ceiling_m});
  MarkerRegistry registry = site.registry;
  registry.markers.insert(registry.markers.end(), filling.added.begin(), filling.added.end());
  save_registry(registry, site.registry_file);
  return filling;
}

}  // namespace

NewSiteApi::NewSiteApi(fs::path folder, fs::path lab, fs::path runs)
    : folder_(std::move(folder)), lab_(std::move(lab)), runs_(std::move(runs)) {
  std::error_code cannot;
  if (fs::exists(fs::symlink_status(folder_, cannot)))
    throw InputError(folder_, 0, "something of that name", "a new folder: nothing is overwritten");
}

bool NewSiteApi::uses_files(const HttpRequest& head) {
  return head.target.starts_with("/api/new/");
}

HttpResponse NewSiteApi::answer(const HttpRequest& request) {
  if (request.method == "GET" || request.method == "HEAD") {
    if (request.target == "/api/site")
      return {.body = json_text(ordered_json{{"new", true}, {"folder", folder_.filename().string()}})};
    if (request.target == "/api/new/runs") return {.body = json_text(runs_with_scans())};
    return page_file(request.target).value_or(refusal(404, "found no such document"));
  }
  if (request.method != "PUT") return refusal(405, "found another method");
  try {
    return {.body = json_text(put(request.target, parse_json(request.body)))};
  } catch (const InputError& error) {
    return refusal(422, error.what());
  } catch (const json::exception& error) {
    return refusal(422, error.what());
  }
}

ordered_json NewSiteApi::put(const std::string& target, const json& sent) {
  if (is_made_) throw InputError("found another request, wanted none: the site is made");
  if (target == "/api/new/plan") return read_sheet(sent);
  if (target == "/api/new/map") return map_of(sent);
  if (target == "/api/new/site") return make(sent);
  throw InputError("found no such document");
}

/// Complaints name the client's file, not the passing one.
ordered_json NewSiteApi::read_sheet(const json& sent) {
  constexpr double most_shown_px = 2400.0;
  const auto name = sent.at("name").get<std::string>();
  PlanOptions options;
  if (!sent.at("metres_per_unit").is_null())
    options.metres_per_unit = number_in(sent, "metres_per_unit", 1e-6, 1000.0);
  const PassingFile file(fs::path(name).extension().string(), bytes_in(sent, "bytes"));
  try {
    sheet_ = read_plan(file.path(), options);
  } catch (const InputError& error) {
    const std::string words = error.what();
    const std::string path = file.path().string();
    throw InputError(words.starts_with(path) ? name + words.substr(path.size()) : words);
  }
  const double shown_px = std::max(1.0, std::max(sheet_.gray.cols, sheet_.gray.rows) / most_shown_px);
  cv::Mat shown;
  cv::resize(sheet_.gray, shown, {}, 1.0 / shown_px, 1.0 / shown_px, cv::INTER_AREA);
  return {
      {"width_px", sheet_.gray.cols},
      {"height_px", sheet_.gray.rows},
      {"metres_per_px", sheet_.metres_per_px ? ordered_json(*sheet_.metres_per_px) : ordered_json(nullptr)},
      {"shown_px", shown_px},
      {"png", base64(png_bytes(shown))}};
}

ordered_json NewSiteApi::runs_with_scans() const {
  const std::vector<std::string> names = RunArchive(runs_).names();
  ordered_json runs = ordered_json::array();
  for (auto name = names.rbegin(); name != names.rend(); ++name) {
    if (!fs::exists(runs_ / *name / "scans.bin")) continue;
    try {
      const ordered_json facts = facts_of_run(runs_ / *name);
      runs.push_back({{"name", *name},
                      {"started", facts.at("started")},
                      {"site", facts.at("site")},
                      {"duration_s", facts.at("duration_s")}});
    } catch (const InputError&) {  // a run that cannot be read hides no other
    }
  }
  return runs;
}

/// Names are compared with those that there are, never used as paths.
ordered_json NewSiteApi::map_of_runs(const json& names, double cell_m) {
  const std::vector<std::string> known = RunArchive(runs_).names();
  std::vector<fs::path> folders;
  for (const std::string& name : known)
    if (std::ranges::find(names, json(name)) != names.end()) folders.push_back(runs_ / name);
  if (folders.empty() || folders.size() != names.size())
    throw InputError("runs: wanted names of /api/new/runs, each once");
  MapFromRunsOptions options;
  options.builder.resolution_m = cell_m;
  const MapFromRuns built = map_from_runs(folders, options);
  registry_ = load_registry(folders.back() / markers_of_run);
  return {{"map", map_with_cells_json(built.map)},
          {"warnings", ordered_json::array()},
          {"markers", registry_->markers.size()}};
}

ordered_json NewSiteApi::map_of(const json& sent) {
  registry_.reset();
  if (sent.contains("runs")) return map_of_runs(sent.at("runs"), number_in(sent, "cell_m", 0.005, 1.0));
  PlanOptions options{.metres_per_unit = {}, .cell_m = number_in(sent, "cell_m", 0.005, 1.0)};
  if (sent.contains("hall_m")) {
    const json& sides = sent.at("hall_m");
    if (!sides.is_array() || sides.size() != 2) throw InputError("hall_m: wanted [width, height]");
    const OccupancyMap hall = empty_hall(sides[0].get<double>(), sides[1].get<double>(), options.cell_m);
    return {{"map", map_with_cells_json(hall)}, {"warnings", ordered_json::array()}, {"markers", 0}};
  }
  if (sheet_.gray.empty()) throw InputError("found no plan, wanted one first");
  options.rotate_rad = radians(number_in(sent, "rotate_deg", -360.0, 360.0));
  options.darkest_free = static_cast<int>(number_in(sent, "threshold", 1.0, 255.0));
  PlanSheet scaled = sheet_;
  scaled.metres_per_px = number_in(sent, "metres_per_px", 1e-6, 1000.0);
  const MapFromPlan made = map_from_sheet(scaled, options);
  return {{"map", map_with_cells_json(made.map)}, {"warnings", made.warnings}, {"markers", 0}};
}

ordered_json NewSiteApi::make(const json& sent) {
  NewSite site{.map = map_from(sent.at("map")),
               .robot_file = lab_ / "robot.yaml",
               .camera_file = lab_ / "camera.yaml",
               .camera_profile = word_in(sent, "camera", {"wide", "paper"}),
               .base_protocol = word_in(sent, "base", {"agilex", "odrive"}),
               .radius_m = number_in(sent, "radius_m", 0.05, 5.0),
               .camera_height_m = number_in(sent, "camera_height_m", 0.05, 10.0)};
  if (site.camera_profile == "paper") site.camera_file = lab_ / "camera_paper.yaml";
  const double ceiling_m = number_in(sent, "ceiling_m", 1.5, 30.0);
  if (ceiling_m < *site.camera_height_m + 0.3)
    throw InputError(fmt::format("ceiling_m: found {}, wanted at least 0.3 m above the camera's {}",
                                 ceiling_m, *site.camera_height_m));
  const bool is_filled = sent.at("fill").get<bool>();
  make_site(site, folder_);
  if (registry_) save_registry(*registry_, load_site(folder_).registry_file);
  ordered_json made{
      {"markers", registry_ ? registry_->markers.size() : 0}, {"uncovered_m2", 0.0}, {"why", ""}};
  try {
    if (is_filled) {
      const Filling filling = filled(folder_, ceiling_m);
      made["markers"] = filling.added.size() + (registry_ ? registry_->markers.size() : 0);
      made["uncovered_m2"] = filling.uncovered_m2;
    }
  } catch (const InputError& error) {  // the site is there all the same
    made["why"] = error.what();
  }
  is_made_ = true;  // not before: then the server makes way for the site's own
  return made;
}

}  // namespace lodestar
