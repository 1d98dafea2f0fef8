#include "app/console/site_coverage.hpp"

#include <algorithm>
#include <cmath>

#include "app/common/rounding.hpp"
#include "app/placement/accepted_issues.hpp"
#include "app/placement/site_floor.hpp"
#include "app/placement/visibility.hpp"

namespace lodestar {
using nlohmann::ordered_json;

ordered_json routes_json(const std::vector<Path>& routes) {
  ordered_json all = ordered_json::array();
  for (const Path& route : routes) {
    ordered_json points = ordered_json::array();
    for (const Vec2& at : route.waypoints_m) points.push_back({at.x(), at.y()});
    all.push_back(points);
  }
  return all;
}

ordered_json coverage_json(const Site& site, const CoveredFloor& floor) {
  return {{"camera", site.default_camera},
          {"camera_height_m", floor.view.camera_height_m},
          {"reach_per_m", floor.view.reach_per_m},
          {"margin_m", floor.view.margin_m},
          {"room_m", floor.room_m}};
}

SiteCoverage::SiteCoverage(const Site& site) : floor_(covered_floor(site)) {
  if (site.octomap_file) sight_lines_.emplace(*site.octomap_file);
}

ordered_json SiteCoverage::issues(const Site& site, const MarkerRegistry& draft,
                                  const std::stop_token& cancelled) const {
  const std::vector<AcceptedIssue> accepted = load_accepted(site.folder);
  ordered_json issues = ordered_json::array();
  for (const RegistryIssue& issue : check_coverage(draft, floor_, cancelled))
    issues.push_back(issue_json(issue, accepted));
  return issues;
}

ordered_json SiteCoverage::deviations(const Site& site, const MarkerRegistry& registry,
                                      const std::stop_token& cancelled) const {
  constexpr double apart_m = 0.25;
  constexpr double most_cells = 40'000.0;  // a second of work; a map in view has few more pixels to a metre
  const OccupancyMap& map = site.map.map;
  VisibilityOptions options = visibility_options(site.robot);
  options.cancelled = cancelled;
  const auto coarser =
      static_cast<int>(std::ceil(std::sqrt(static_cast<double>(map.cells.size()) / most_cells)));
  options.stride = std::max({1, static_cast<int>(std::lround(apart_m / map.resolution_m)), coarser});
  const Visibility seen = visibility_of(map, registry, site.cameras.at(site.default_camera),
                                        sight_lines_ ? &*sight_lines_ : nullptr, options);
  ordered_json sigmas = ordered_json::array();
  for (int row = 0; row < map.rows; row += options.stride) {
    for (int column = 0; column < map.columns; column += options.stride) {
      const Cell middle = options.cell_in_stride(map, {column, row});
      const std::optional<CellView>& cell = seen.cells[map.index(middle)];
      const bool is_known = cell && cell->position_sigma_m;
      sigmas.push_back(is_known ? ordered_json(rounded(mm_per_m * *cell->position_sigma_m, 1e3))
                                : ordered_json(nullptr));
    }
  }
  return {{"stride", options.stride},
          {"columns", (map.columns + options.stride - 1) / options.stride},
          {"sigma_mm", sigmas}};
}

}  // namespace lodestar
