#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <stop_token>

#include "app/placement/coverage.hpp"
#include "app/site/site.hpp"
#include "maps/sight_lines.hpp"

// What the editor shows of a site besides its map: the robot's usual routes, and what its camera covers.
namespace lodestar {

/// The paths of the usual routes: [[x, y], ...] each.
nlohmann::ordered_json routes_json(const std::vector<Path>& routes);

/// What the default camera covers at every heading: camera_height_m; a radius of reach_per_m per metre of
/// height above it, less margin_m; and where coverage counts: not nearer than room_m to a cell that is not
/// free.
nlohmann::ordered_json coverage_json(const Site& site, const CoveredFloor& floor);

/// The floor that markers are to cover, and the occlusions where the site has an OctoMap. What is cancelled
/// ends early, with what it has: nobody waits for it any more.
class SiteCoverage {
 public:
  explicit SiteCoverage(const Site& site);

  [[nodiscard]] const CoveredFloor& floor() const { return floor_; }

  /// All errors and warnings of a draft, as `lodestar markers check --site` reports them.
  [[nodiscard]] nlohmann::ordered_json issues(const Site& site, const MarkerRegistry& draft,
                                              const std::stop_token& cancelled = {}) const;

  /// Expected standard deviation of a single fix, as `lodestar map visibility` computes it, at every
  /// `stride`-th cell: {stride, columns, sigma_mm: [...]}, null where some heading sees no marker or the
  /// robot cannot be.
  [[nodiscard]] nlohmann::ordered_json deviations(const Site& site, const MarkerRegistry& registry,
                                                  const std::stop_token& cancelled = {}) const;

 private:
  CoveredFloor floor_;
  std::optional<SightLines> sight_lines_;
};

}  // namespace lodestar
