#pragma once

#include <optional>

#include "maps/camera_model.hpp"

namespace lodestar {

/// The image of a small round face: very nearly an ellipse, whatever the lens.
struct ProjectedDisc {
  Vec2 center_px = Vec2::Zero();  ///< centroid of the image's area, which is not the image of the middle
  Eigen::Matrix2d unit_from_px = Eigen::Matrix2d::Zero();  ///< takes the ellipse to the unit circle
  double radius_px = 0.0;                                  ///< of a circle of the same area
  Vec2 half_size_px = Vec2::Zero();                        ///< of the upright box around it
};

/// The ellipse that has the moments of the projected outline. `camera_from_map` * z of the map is the face's
/// normal: the face is horizontal. Nothing when it is behind the camera or seen edge on.
std::optional<ProjectedDisc> project_disc(const Vec3& center_in_map, double radius_m,
                                          const Eigen::Isometry3d& camera_from_map,
                                          const CameraModel& camera);

}  // namespace lodestar
