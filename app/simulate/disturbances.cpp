#include "app/simulate/disturbances.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "maps/random.hpp"

namespace lodestar {
namespace {

std::set<int> nearest_ids(const MarkerRegistry& registry, const std::vector<Vec2>& places_m) {
  std::set<int> ids;
  for (const Vec2& place_m : places_m) {
    const auto nearest = std::ranges::min_element(registry.markers, {}, [&](const RegisteredMarker& marker) {
      return (map_from_marker(registry, marker).translation().head<2>() - place_m).norm();
    });
    if (nearest != registry.markers.end()) ids.insert(nearest->id);
  }
  return ids;
}

MarkerRegistry with_markers_removed(const MarkerRegistry& registry, double share,
                                    const std::vector<Vec2>& places_m, std::uint64_t seed) {
  constexpr std::uint64_t removal_stream = 3;
  Random random = Random(seed).stream(removal_stream);
  const std::set<int> stay = nearest_ids(registry, places_m);
  std::vector<int> removable;
  for (const RegisteredMarker& marker : registry.markers)
    if (!stay.contains(marker.id)) removable.push_back(marker.id);

  const auto wanted =
      static_cast<std::size_t>(std::lround(share * static_cast<double>(registry.markers.size())));
  std::set<int> removed;
  while (removed.size() < std::min(wanted, removable.size()))
    removed.insert(removable[random.below(removable.size())]);
  MarkerRegistry left = registry;
  std::erase_if(left.markers, [&](const RegisteredMarker& marker) { return removed.contains(marker.id); });
  return left;
}

MarkerRegistry with_markers_misplaced(MarkerRegistry registry, const Disturbances& by, std::uint64_t seed) {
  constexpr std::uint64_t misplacing_stream = 4;
  const Random random = Random(seed).stream(misplacing_stream);
  for (std::size_t i = 0; i < registry.markers.size(); ++i) {
    Random of_marker = random.stream(i);
    RegisteredMarker& marker = registry.markers[i];
    marker.position_m.x() += by.misplaced_m * of_marker.normal();
    marker.position_m.y() += by.misplaced_m * of_marker.normal();
    marker.yaw_rad += by.misturned_rad * of_marker.normal();
  }
  return registry;
}

}  // namespace

SimulationOptions with_disturbances(SimulationOptions options, const Disturbances& disturbances) {
  if (disturbances.lost_frames) options.camera.lost_frame_probability = *disturbances.lost_frames;
  if (disturbances.unequal_wheels) {
    options.base.left_wheel_scale = 1.0 + 0.5 * *disturbances.unequal_wheels;
    options.base.right_wheel_scale = 1.0 - 0.5 * *disturbances.unequal_wheels;
  }
  options.camera.marker_tilt_sigma_rad = disturbances.tilted_rad;
  options.camera.print_scale = disturbances.print_scale;
  if (disturbances.plain_ceiling) {
    options.camera.texture_gray = 0.0;
    options.camera.tubes = options.camera.lamps = options.camera.glints = false;
  }
  return options;
}

MarkerRegistry hung_markers(const MarkerRegistry& registry, const Disturbances& disturbances,
                            const std::vector<Vec2>& places_m, std::uint64_t seed) {
  const MarkerRegistry left = with_markers_removed(disturbances.hung.value_or(registry),
                                                   disturbances.removed_markers, places_m, seed);
  if (disturbances.misplaced_m == 0.0 && disturbances.misturned_rad == 0.0) return left;
  return with_markers_misplaced(left, disturbances, seed);
}

}  // namespace lodestar
