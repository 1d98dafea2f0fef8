#pragma once

#include <optional>

#include "maps/camera_model.hpp"

namespace lodestar {

/// The image of a small disc: very nearly an ellipse for any lens.
struct ProjectedDisc {
  /// Centroid of the image area, which differs from the image of the disc's centre.
  Vec2 center_px = Vec2::Zero();
  Eigen::Matrix2d unit_from_px = Eigen::Matrix2d::Zero();  ///< maps the ellipse to the unit circle
  double radius_px = 0.0;                                  ///< of a circle of equal area
  Vec2 half_size_px = Vec2::Zero();                        ///< of the axis-aligned bounding box
};

/// The ellipse with the moments of the projected outline. The disc is horizontal: its normal is the map's z
/// axis. Empty when it is behind the camera or seen edge-on.
std::optional<ProjectedDisc> project_disc(const Vec3& center_in_map, double radius_m,
                                          const Eigen::Isometry3d& camera_from_map,
                                          const CameraModel& camera);

}  // namespace lodestar
