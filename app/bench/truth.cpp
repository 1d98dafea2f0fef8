#include "app/bench/truth.hpp"

#include <algorithm>

#include "app/bench/scene.hpp"

namespace lodestar {
namespace {

bool is_of(const ReadMarker& reading, const TrueMarker& marker) {
  constexpr double near_px = 5.0;  // half a pitch from 3 m
  return marker.id == reading.id && (marker.center_px - reading.center_px).norm() < near_px;
}

}  // namespace

std::vector<TrueMarker> markers_in_view(const BenchMethod& method, const MarkerRegistry& registry,
                                        const Eigen::Isometry3d& map_from_camera, const CameraModel& camera) {
  constexpr double margin_px = 100.0;
  const Eigen::Isometry3d camera_from_map = map_from_camera.inverse();
  std::vector<TrueMarker> markers;
  for (std::size_t i = 0; i < registry.markers.size(); ++i) {
    const Vec3 middle = map_from_marker(registry, registry.markers[i]) * marker_middle;
    const std::optional<Vec2> pixel = camera.project(camera_from_map * middle);
    if (pixel && camera.contains(*pixel, -margin_px)) markers.push_back({method.id_at(registry, i), *pixel});
  }
  return markers;
}

bool is_right(const ReadMarker& reading, const std::vector<TrueMarker>& truth) {
  return std::ranges::any_of(truth, [&](const TrueMarker& marker) { return is_of(reading, marker); });
}

bool is_read(const TrueMarker& marker, const std::vector<ReadMarker>& readings) {
  return std::ranges::any_of(readings, [&](const ReadMarker& reading) { return is_of(reading, marker); });
}

ReadingCount judged(const std::vector<ReadMarker>& readings, const std::vector<TrueMarker>& truth) {
  ReadingCount count;
  for (const ReadMarker& reading : readings) ++(is_right(reading, truth) ? count.right : count.wrong);
  return count;
}

}  // namespace lodestar
