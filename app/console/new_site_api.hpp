#pragma once

#include <atomic>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/net/http.hpp"
#include "app/site/floor_plan.hpp"
#include "app/site/new_site.hpp"
#include "maps/marker_registry.hpp"

namespace lodestar {

/// What a page needs that makes a site of nothing:
///
///   GET  /, /app.js, ...   the page
///   GET  /api/site         {"new": true, folder}
///   GET  /api/new/runs     [{name, started, site, duration_s}]: drives with scans, the newest first
///   PUT  /api/new/plan     {name, bytes, metres_per_unit}
///                          -> {width_px, height_px, metres_per_px, shown_px, png}
///   PUT  /api/new/map      {metres_per_px, rotate_deg, threshold, cell_m} of the plan, {hall_m, cell_m} or
///                          {runs, cell_m} -> {map, warnings, markers}
///   PUT  /api/new/site     {map, base, camera, radius_m, camera_height_m, ceiling_m, fill} -> {markers,
///                          uncovered_m2, why}: makes the folder; `why` it has no markers, where it should
///
/// A map of runs is in the frame of the markers that the robot drove under: the site keeps those of the
/// newest of them, `markers` in number.
///
/// `bytes`, `png` and the map's cells are base64. `map`: {columns, rows, resolution_m, x_m, y_m, cells}, one
/// byte a cell, bottom row first: 0 free, 100 occupied, 255 unknown. `metres_per_px` is null where the plan
/// does not say; `shown_px` are the plan's pixels in one of the PNG. Nothing is written but by the last.
class NewSiteApi {
 public:
  /// `folder` is made; `lab` is the site whose robot and cameras it begins with; `runs` has run folders, or
  /// need not exist. Throws InputError where
  /// there is something of that name already.
  NewSiteApi(std::filesystem::path folder, std::filesystem::path lab, std::filesystem::path runs);

  /// From one thread at a time, but for is_made().
  [[nodiscard]] HttpResponse answer(const HttpRequest& request);

  [[nodiscard]] bool is_made() const { return is_made_; }

  /// Which requests take long.
  [[nodiscard]] static bool uses_files(const HttpRequest& head);

 private:
  [[nodiscard]] nlohmann::ordered_json put(const std::string& target, const nlohmann::json& sent);
  [[nodiscard]] nlohmann::ordered_json read_sheet(const nlohmann::json& sent);
  [[nodiscard]] nlohmann::ordered_json runs_with_scans() const;
  [[nodiscard]] nlohmann::ordered_json map_of(const nlohmann::json& sent);
  [[nodiscard]] nlohmann::ordered_json map_of_runs(const nlohmann::json& names, double cell_m);
  [[nodiscard]] nlohmann::ordered_json make(const nlohmann::json& sent);

  std::filesystem::path folder_;
  std::filesystem::path lab_;
  std::filesystem::path runs_;
  PlanSheet sheet_;
  std::optional<MarkerRegistry> registry_;  ///< of the runs that the map is of
  std::atomic<bool> is_made_ = false;
};

}  // namespace lodestar
