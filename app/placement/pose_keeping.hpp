#pragma once

#include <optional>

#include "app/placement/visibility.hpp"
#include "planning/uncertainty_constrained_planner.hpp"

namespace lodestar {

/// What a drive shall keep to so that the robot never loses its way; one of the two, or nothing.
struct PoseKeepingOptions {
  std::optional<double> max_sigma_m;   ///< the predicted deviation of the position stays below this
  std::optional<int> markers_in_view;  ///< at least so many are in view, whatever the heading
  double blind_way_m = 0.0;            ///< with markers_in_view: but for stretches no longer than this
  double drift_m_per_m = 0.03;         ///< with max_sigma_m: by so much the wheels lose the way between fixes

  [[nodiscard]] bool wanted() const { return max_sigma_m || markers_in_view; }
};

/// What is seen from where the middle of a disc of this radius may be, cells that it only cuts included.
Visibility view_on_drives(const OccupancyMap& map, const MarkerRegistry& registry, const CameraModel& camera,
                          VisibilityOptions options, double radius_m);

/// The same for planners, from what the robot sees in each cell.
PoseKeeping pose_keeping(const Visibility& visibility, const PoseKeepingOptions& options);

}  // namespace lodestar
