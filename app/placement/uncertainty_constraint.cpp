#include "app/placement/uncertainty_constraint.hpp"

#include <algorithm>
#include <limits>

namespace lodestar {
namespace {

constexpr float blind = std::numeric_limits<float>::infinity();

float fix_sigma_m(const std::optional<CellView>& view) {
  return view && view->position_sigma_m ? static_cast<float>(*view->position_sigma_m) : blind;
}

}  // namespace

Visibility view_on_drives(const OccupancyMap& map, const MarkerRegistry& registry, const CameraModel& camera,
                          VisibilityOptions options, double radius_m) {
  options.robot_radius_m = std::max(radius_m - map.resolution_m, 0.0);
  return visibility_of(map, registry, camera, nullptr, options);
}

/// A number of markers in view is expressed as a deviation too: 0 where there are enough, elsewhere the
/// distance driven since.
UncertaintyConstraint uncertainty_constraint(const Visibility& visibility,
                                             const UncertaintyConstraintOptions& options) {
  UncertaintyConstraint constraint{.fix_sigma_m = {},
                                   .drift_m_per_m = options.max_sigma_m ? options.drift_m_per_m : 1.0,
                                   .limit_m = options.max_sigma_m.value_or(options.blind_way_m)};
  constraint.fix_sigma_m.reserve(visibility.cells.size());
  for (const std::optional<CellView>& view : visibility.cells) {
    const bool sees_enough = view && view->least >= options.markers_in_view.value_or(0);
    constraint.fix_sigma_m.push_back(options.max_sigma_m ? fix_sigma_m(view) : sees_enough ? 0.0F : blind);
  }
  return constraint;
}

}  // namespace lodestar
