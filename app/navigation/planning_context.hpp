#pragma once

#include <span>

#include "control/drive_options.hpp"
#include "control/forward_clearance.hpp"
#include "planning/margin_planner.hpp"

namespace lodestar {

/// How far from everything a path keeps where there is room, so that a robot which must go some way without a
/// marker may be unsure of its place.
enum class Margins {
  usual,
  wide  ///< for one that has been too unsure
};

/// They, widest first.
std::span<const double> margins_m(Margins margins);

/// What a robot plans and drives on. Made anew for every map.
struct PlanningContext {
  PlanningContext(const OccupancyMap& known, const GridPlannerOptions& options, Margins margins);

  /// For a path over this ground: corners are cut only where there is room for it.
  [[nodiscard]] DriveOptions drive_options(const Path& path, DriveOptions options) const;

  OccupancyMap map;
  MarginPlanner planner;
  ForwardClearance forward_clearance;
};

}  // namespace lodestar
