#include "drivers/simulation/disturbed_ceiling.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "maps/marker.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

using Markers = std::vector<RegisteredMarker>;

Vec3 shift_of(const Fault& fault) {
  return fault.shift_m * Vec3(std::cos(fault.direction_rad), std::sin(fault.direction_rad), 0.0);
}

RegisteredMarker moved(RegisteredMarker marker, const Fault& fault) {
  marker.position_m += shift_of(fault);
  marker.yaw_rad += fault.turn_rad;
  return marker;
}

Markers::iterator neighbour_of(Markers& markers, Markers::iterator marker) {
  auto nearest = markers.end();
  for (auto other = markers.begin(); other != markers.end(); ++other) {
    if (other == marker) continue;
    const bool is_nearer = nearest == markers.end() || (other->position_m - marker->position_m).norm() <
                                                           (nearest->position_m - marker->position_m).norm();
    if (is_nearer) nearest = other;
  }
  return nearest;
}

void disturb(Markers& markers, const Fault& fault) {
  if (fault.kind == FaultKind::markers_occluded && !fault.marker) return markers.clear();
  const auto marker = std::ranges::find(markers, fault.marker, &RegisteredMarker::id);
  if (!fault.marker || marker == markers.end()) return;
  const auto neighbour = neighbour_of(markers, marker);
  switch (fault.kind) {
    case FaultKind::markers_occluded:
      markers.erase(marker);
      return;
    case FaultKind::marker_moved:
      *marker = moved(*marker, fault);
      return;
    case FaultKind::marker_duplicated:
      markers.push_back(moved(*marker, fault));
      return;
    case FaultKind::marker_wrong_id:
      if (neighbour != markers.end()) marker->id = neighbour->id;
      return;
    case FaultKind::markers_swapped:
      if (neighbour != markers.end()) std::swap(marker->id, neighbour->id);
      return;
    default:
      return;
  }
}

}  // namespace

MarkerRegistry disturbed(const MarkerRegistry& registry, const std::vector<Fault>& active) {
  MarkerRegistry result = registry;
  for (const Fault& fault : active) disturb(result.markers, fault);
  return result;
}

std::vector<CeilingDisc> decoy_lamps(const MarkerRegistry& registry, const std::vector<Fault>& active,
                                     std::uint64_t seed) {
  std::vector<CeilingDisc> lamps;
  for (const Fault& fault : active) {
    if (fault.kind != FaultKind::decoy_lamps || !fault.marker) continue;
    const RegisteredMarker* marker = registry.find(*fault.marker);
    if (marker == nullptr) continue;
    const Vec3 center_m = map_from_marker(registry, *marker).translation();
    Random random(seed);
    for (int i = 0; i < static_cast<int>(fault.count); ++i) {
      const double angle_rad = random.uniform(0.0, 2.0 * std::numbers::pi);
      const double distance_m = fault.shift_m * std::sqrt(random.uniform());
      const Vec3 offset_m = distance_m * Vec3(std::cos(angle_rad), std::sin(angle_rad), 0.0);
      lamps.push_back({center_m + offset_m, marker_dot_radius_m, 250.0});
    }
  }
  return lamps;
}

}  // namespace lodestar
