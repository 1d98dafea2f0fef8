#include "maps/marker_registry.hpp"

namespace lodestar {

const RegisteredMarker* MarkerRegistry::find(int id) const {
  const RegisteredMarker* found = nullptr;
  for (const RegisteredMarker& marker : markers) {
    if (marker.id != id) continue;
    if (found != nullptr) return nullptr;
    found = &marker;
  }
  return found;
}

std::vector<int> registered_ids(const MarkerRegistry& registry) {
  std::vector<int> ids;
  ids.reserve(registry.markers.size());
  for (const RegisteredMarker& marker : registry.markers) ids.push_back(marker.id);
  return ids;
}

Eigen::Isometry3d map_from_marker(const MarkerRegistry& registry, const RegisteredMarker& marker) {
  Eigen::Isometry3d registry_from_marker =
      lifted({marker.position_m.head<2>(), marker.yaw_rad}, marker.position_m.z());
  registry_from_marker.rotate(Eigen::DiagonalMatrix<double, 3>(1.0, -1.0, -1.0).toDenseMatrix());
  return lifted(registry.map_from_registry) * registry_from_marker;
}

}  // namespace lodestar
