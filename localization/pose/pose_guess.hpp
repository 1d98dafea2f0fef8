#pragma once

#include <optional>
#include <span>

#include "localization/pose/map_estimate.hpp"
#include "localization/pose/p3p.hpp"

// First guesses of the camera's pose, in closed form.
namespace lodestar {

/// P3P on a marker's O, X and Y, Eq. (10)-(15): up to four poses, here each as camera_from_map.
P3pSolutions p3p_guesses(const std::array<SurveyedDot, 3>& direction_dots, const CameraModel& camera);

/// With the tilt as the prior has it, the ceiling's points and their rays, brought to unit height, are
/// similar figures: turned by the heading, scaled by the distance. Least squares over dots at one height.
std::optional<Eigen::Isometry3d> level_guess(std::span<const SurveyedDot> dots, const CameraModel& camera,
                                             const PosePrior& prior);

/// The other pose that shows dots of one height at nearly the same places: small and far, a plane looks the
/// same when its near and far sides are swapped, that is, mirrored across the line of sight.
Eigen::Isometry3d mirrored(const Eigen::Isometry3d& map_from_camera, std::span<const SurveyedDot> dots);

}  // namespace lodestar
