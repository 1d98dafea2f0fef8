#pragma once

#include <memory>
#include <span>

#include "control/drive_options.hpp"
#include "planning/margin_planner.hpp"

namespace lodestar {

/// The clearance that a path keeps where there is room, as tolerance for a pose that becomes uncertain
/// between markers.
enum class Margins {
  usual,
  wide  ///< after the pose was too uncertain to go on
};

/// The margins to try, widest first.
std::span<const double> margins_m(Margins margins);

/// The planner on a map, with the field that the clearance ahead shares.
struct PlanningContext {
  PlanningContext(std::shared_ptr<const ObstacleField> known, const GridPlannerOptions& options,
                  Margins margins);

  /// For a path on this map: blends corners only when all of them have the clearance for it.
  [[nodiscard]] DriveOptions drive_options(const Path& path, DriveOptions options) const;

  std::shared_ptr<const ObstacleField> field;
  MarginPlanner planner;
};

}  // namespace lodestar
