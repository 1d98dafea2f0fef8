#pragma once

#include <atomic>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/net/http.hpp"
#include "app/site/floor_plan.hpp"
#include "app/site/new_site.hpp"

namespace lodestar {

/// What a page needs that makes a site of nothing:
///
///   GET  /, /app.js, ...   the page
///   GET  /api/site         {"new": true, folder}
///   PUT  /api/new/plan     {name, bytes, metres_per_unit} -> {width_px, height_px, metres_per_px, shown_px,
///   png} PUT  /api/new/map      {metres_per_px, rotate_deg, threshold, cell_m} of the plan, or {hall_m,
///   cell_m}
///                          -> {map, warnings}
///   PUT  /api/new/site     {map, base, camera, radius_m, camera_height_m, ceiling_m, fill} -> {markers,
///                          uncovered_m2, why}: makes the folder; `why` it has no markers, where it should
///
/// `bytes`, `png` and the map's cells are base64. `map`: {columns, rows, resolution_m, x_m, y_m, cells}, one
/// byte a cell, bottom row first: 0 free, 100 occupied, 255 unknown. `metres_per_px` is null where the plan
/// does not say; `shown_px` are the plan's pixels in one of the PNG. Nothing is written but by the last.
class NewSiteApi {
 public:
  /// `folder` is made; `lab` is the site whose robot and cameras it begins with. Throws InputError where
  /// there is something of that name already.
  NewSiteApi(std::filesystem::path folder, std::filesystem::path lab);

  /// From one thread at a time, but for is_made().
  [[nodiscard]] HttpResponse answer(const HttpRequest& request);

  [[nodiscard]] bool is_made() const { return is_made_; }

  /// Which requests take long.
  [[nodiscard]] static bool uses_files(const HttpRequest& head);

 private:
  [[nodiscard]] nlohmann::ordered_json put(const std::string& target, const nlohmann::json& sent);
  [[nodiscard]] nlohmann::ordered_json read_sheet(const nlohmann::json& sent);
  [[nodiscard]] nlohmann::ordered_json map_of(const nlohmann::json& sent) const;
  [[nodiscard]] nlohmann::ordered_json make(const nlohmann::json& sent);

  std::filesystem::path folder_;
  std::filesystem::path lab_;
  PlanSheet sheet_;
  std::atomic<bool> is_made_ = false;
};

}  // namespace lodestar
