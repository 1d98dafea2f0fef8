#pragma once

#include <optional>

#include "app/placement/visibility.hpp"
#include "planning/uncertainty_constrained_planner.hpp"

namespace lodestar {

/// Constraint on paths so that the robot stays localized; one of the two, or neither.
struct UncertaintyConstraintOptions {
  std::optional<double> max_sigma_m;   ///< the predicted deviation of the position stays below this
  std::optional<int> markers_in_view;  ///< at least this many in view, at every heading
  double blind_way_m = 0.0;            ///< with markers_in_view: except for stretches up to this length
  double drift_m_per_m = 0.03;         ///< with max_sigma_m: odometry drift between fixes

  [[nodiscard]] bool wanted() const { return max_sigma_m || markers_in_view; }
};

/// Visibility from all cells in which the centre of a disc of this radius may be, cells that it only touches
/// included.
Visibility view_on_drives(const OccupancyMap& map, const MarkerRegistry& registry, const CameraModel& camera,
                          VisibilityOptions options, double radius_m);

/// The constraint for planners, from the visibility of each cell.
UncertaintyConstraint uncertainty_constraint(const Visibility& visibility,
                                             const UncertaintyConstraintOptions& options);

}  // namespace lodestar
