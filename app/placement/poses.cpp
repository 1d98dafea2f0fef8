#include "app/placement/poses.hpp"

#include <cmath>

#include "maps/marker.hpp"

namespace lodestar {
namespace {

Eigen::Isometry3d marker_from(MarkerFrame frame) {
  constexpr double to_center_m = 0.5 * (marker_grid_size - 1) * marker_pitch_m;
  Eigen::Isometry3d marker_from_frame = Eigen::Isometry3d::Identity();
  if (frame == MarkerFrame::at_o) return marker_from_frame;
  marker_from_frame.translation() = Vec3(to_center_m, to_center_m, 0.0);
  if (frame == MarkerFrame::out_of_the_center) {
    marker_from_frame.linear() << 0.0, 1.0, 0.0,  //
        0.0, 0.0, 1.0,                            //
        1.0, 0.0, 0.0;
  }
  return marker_from_frame;
}

}  // namespace

Eigen::Isometry3d map_from_frame(const MarkerRegistry& registry, const RegisteredMarker& marker,
                                 MarkerFrame frame) {
  return map_from_marker(registry, marker) * marker_from(frame);
}

std::optional<RegisteredMarker> marker_at(int id, const Eigen::Isometry3d& map_from_frame,
                                          MarkerFrame frame) {
  const Eigen::Isometry3d map_from_marker = map_from_frame * marker_from(frame).inverse();
  const double down = -map_from_marker.linear()(2, 2);
  if (!(down >= std::cos(radians(5.0)))) return std::nullopt;
  return RegisteredMarker{id, map_from_marker.translation(), flattened(map_from_marker).yaw_rad};
}

}  // namespace lodestar
