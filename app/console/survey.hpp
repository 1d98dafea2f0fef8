#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "app/site.hpp"
#include "maps/height_bands.hpp"
#include "maps/sight_lines.hpp"

// What the editor is told of a site beside its map: where the robot usually drives, and what it can see.
namespace lodestar {

/// The paths of the usual drive, from the start to each goal in turn: [[x, y], ...] each. Legs that cannot be
/// planned are left out.
nlohmann::ordered_json usual_routes(const Site& site);

/// What the default camera covers however the robot has turned: camera_height_m, reach_per_m of height above
/// it, less margin_m.
nlohmann::ordered_json coverage_json(const Site& site);

/// What hides markers, where the site has an OctoMap.
class SiteView {
 public:
  explicit SiteView(const Site& site);

  /// Nothing without an OctoMap.
  [[nodiscard]] const std::optional<HeightBands>& heights() const { return heights_; }

  /// To be expected of a single fix, as `lodestar map visibility` has it, at every so many-th cell:
  /// {stride, columns, sigma_mm: [...]}, null where some heading sees no marker or no robot can be.
  [[nodiscard]] nlohmann::ordered_json deviations(const Site& site, const MarkerRegistry& registry) const;

 private:
  std::optional<SightLines> sight_lines_;
  std::optional<HeightBands> heights_;
};

}  // namespace lodestar
