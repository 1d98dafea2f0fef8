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

}  // namespace

SimulationOptions with_disturbances(SimulationOptions options, const Disturbances& disturbances) {
  if (disturbances.lost_frames) options.camera.lost_frame_probability = *disturbances.lost_frames;
  if (disturbances.unequal_wheels) {
    options.base.left_wheel_scale = 1.0 + 0.5 * *disturbances.unequal_wheels;
    options.base.right_wheel_scale = 1.0 - 0.5 * *disturbances.unequal_wheels;
  }
  if (disturbances.plain_ceiling) {
    options.camera.texture_gray = 0.0;
    options.camera.tubes = options.camera.lamps = options.camera.glints = false;
  }
  return options;
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

}  // namespace lodestar
