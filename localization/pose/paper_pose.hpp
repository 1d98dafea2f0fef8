#pragma once

#include <optional>
#include <span>

#include "localization/detection/detected_marker.hpp"
#include "maps/camera_model.hpp"
#include "maps/marker_registry.hpp"
#include "maps/stamp.hpp"

// The pose as the paper computes it (sections 4.1, 5 and 6.3), for comparison: one marker, its three
// direction dots, six degrees of freedom, no prior, no covariance. docs/method.md gives it equation by
// equation.
namespace lodestar {

struct PaperFix {
  Stamp stamp;
  int id = 0;               ///< of the optimal marker
  double confidence = 0.0;  ///< P(S) of Eq. (3)
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
};

/// P3P (Eq. (10)-(15)) on O, X and Y of the optimal marker, the first of `markers` in the detector's order
/// (Eq. (1)); the others are not used. The paper does not say which of up to four solutions it takes. Here it
/// is the one whose optical axis is nearest to the vertical, the best choice for a sensor that looks up at a
/// ceiling. Nothing when the optimal marker is not registered exactly once, or when noise leaves Eq. (10)
/// without a real solution.
std::optional<PaperFix> fix_pose_as_in_paper(Stamp stamp, std::span<const DetectedMarker> markers,
                                             const MarkerRegistry& registry, const CameraModel& camera);

/// Eq. (17): the robot's position and heading from the sensor's (x_t, y_t) and theta alone. With the camera r
/// ahead on the robot's x axis and aligned with the robot, this is x_r = x_t - r cos(theta), y_r = y_t - r
/// sin(theta); another offset or mount yaw adds a constant angle. Roll, pitch and height are ignored.
Pose2 compensate_mount_as_in_paper(const Eigen::Isometry3d& map_from_camera,
                                   const Eigen::Isometry3d& base_from_camera);

}  // namespace lodestar
