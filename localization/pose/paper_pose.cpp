#include "localization/pose/paper_pose.hpp"

#include <array>

#include "localization/pose/pose_guess.hpp"

namespace lodestar {
namespace {

/// O, X and Y in the image and on the ceiling.
std::array<SurveyedDot, 3> direction_dots_of(const DetectedMarker& marker,
                                             const Eigen::Isometry3d& map_from_marker) {
  const auto surveyed = [&](GridCell cell, const Vec2& center_px) {
    const Vec2 in_marker = cell_in_marker(cell);
    return SurveyedDot{.point_in_map = map_from_marker * Vec3(in_marker.x(), in_marker.y(), 0.0),
                       .center_px = center_px};
  };
  return {surveyed(cell_of_o, marker.o_px), surveyed(cell_of_x, marker.x_px),
          surveyed(cell_of_y, marker.y_px)};
}

/// The cosine of the angle between the optical axis and the vertical.
double uprightness(const Eigen::Isometry3d& map_from_camera) {
  return map_from_camera.linear()(2, 2);
}

}  // namespace

std::optional<PaperFix> fix_pose_as_in_paper(Stamp stamp, std::span<const DetectedMarker> markers,
                                             const MarkerRegistry& registry, const CameraModel& camera) {
  if (markers.empty()) return std::nullopt;
  const DetectedMarker& optimal = markers.front();
  const RegisteredMarker* const registered = registry.find(optimal.id);
  if (registered == nullptr) return std::nullopt;
  const auto direction_dots = direction_dots_of(optimal, map_from_marker(registry, *registered));
  std::optional<PaperFix> fix;
  for (const Eigen::Isometry3d& camera_from_map : p3p_guesses(direction_dots, camera)) {
    const Eigen::Isometry3d map_from_camera = camera_from_map.inverse();
    if (fix && uprightness(map_from_camera) <= uprightness(fix->map_from_camera)) continue;
    fix = PaperFix{stamp, optimal.id, optimal.confidence, map_from_camera};
  }
  return fix;
}

Pose2 compensate_mount_as_in_paper(const Eigen::Isometry3d& map_from_camera,
                                   const Eigen::Isometry3d& base_from_camera) {
  return flattened(map_from_camera) * inverse(flattened(base_from_camera));
}

}  // namespace lodestar
