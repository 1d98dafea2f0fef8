#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "app/placement/coverage.hpp"
#include "app/site/site.hpp"
#include "maps/sight_lines.hpp"

// What the editor is told of a site beside its map: where the robot usually drives, and what it can see.
namespace lodestar {

/// The paths of the usual drive: [[x, y], ...] each.
nlohmann::ordered_json routes_json(const std::vector<Path>& routes);

/// What the default camera covers however the robot has turned: camera_height_m, reach_per_m of height above
/// it, less margin_m; and where it counts: not nearer than room_m to what is not free.
nlohmann::ordered_json coverage_json(const Site& site, const CoveredFloor& floor);

/// What markers are to cover, and what hides them where the site has an OctoMap.
class SiteCoverage {
 public:
  explicit SiteCoverage(const Site& site);

  [[nodiscard]] const CoveredFloor& floor() const { return floor_; }

  /// All that is wrong or doubtful with a draft, as `lodestar markers check --site` has it.
  [[nodiscard]] nlohmann::ordered_json issues(const MarkerRegistry& draft) const;

  /// To be expected of a single fix, as `lodestar map visibility` has it, at every so many-th cell:
  /// {stride, columns, sigma_mm: [...]}, null where some heading sees no marker or no robot can be.
  [[nodiscard]] nlohmann::ordered_json deviations(const Site& site, const MarkerRegistry& registry) const;

 private:
  CoveredFloor floor_;
  std::optional<SightLines> sight_lines_;
};

}  // namespace lodestar
