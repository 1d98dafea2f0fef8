#pragma once

#include <string>
#include <vector>

#include "app/placement/sheet.hpp"
#include "maps/marker_registry.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

/// Sheets of the markers of a site: above the marker stand the site and the date, where the square's centre
/// hangs, where its arrow points, how far the nearer walls are, and a plan with a cross at that place.
class PlaceSheets {
 public:
  /// `date`: as it is to be printed. The map must outlive this.
  PlaceSheets(const OccupancyMap& map, std::string site, std::string date, PaperSize paper);

  [[nodiscard]] SheetPage page(const MarkerRegistry& registry, const RegisteredMarker& marker) const;

 private:
  [[nodiscard]] Vec2 on_plan_mm(const Vec2& in_map_m) const;
  void draw_plan();

  const OccupancyMap& map_;
  std::string head_;
  PaperSize paper_;
  double mm_per_cell_ = 0.0;
  Vec2 corner_mm_;  ///< lower left, of the plan
  std::vector<SheetMark> plan_;
};

}  // namespace lodestar
