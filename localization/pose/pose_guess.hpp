#pragma once

#include <optional>
#include <span>

#include "localization/pose/map_estimate.hpp"
#include "localization/pose/p3p.hpp"

// Closed-form initial guesses of the camera's pose.
namespace lodestar {

/// P3P on a marker's O, X and Y, Eq. (10)-(15): up to four poses, each as camera_from_map.
P3pSolutions p3p_guesses(const std::array<SurveyedDot, 3>& direction_dots, const CameraModel& camera);

/// With the prior's tilt, the ceiling's points and their rays, scaled to unit height, are similar figures:
/// rotated by the heading, scaled by the distance. Least squares over dots at one height.
std::optional<Eigen::Isometry3d> level_guess(std::span<const SurveyedDot> dots, const CameraModel& camera,
                                             const PosePrior& prior);

/// The other mode of the planar ambiguity for dots of one height: small and far, a plane looks nearly the
/// same when its near and far sides are swapped, that is, mirrored across the line of sight.
Eigen::Isometry3d mirrored(const Eigen::Isometry3d& map_from_camera, std::span<const SurveyedDot> dots);

}  // namespace lodestar
