#pragma once

#include "maps/geometry.hpp"

namespace lodestar {

/// What the linear view leaves out of the covariance of the camera's place (m^2): with its tilt in doubt the
/// camera swings about the dots on an arc, not on a straight line. Turned by d with the dots' centre held at
/// u from the camera, it leaves the tangent by s = -d x (d x u) / 2, a quadratic form of d for each
/// coordinate, so that the mean of s s^T follows from the covariance of d (Isserlis' theorem for the fourth
/// moments of a Gaussian).
Eigen::Matrix3d arc_covariance(const Vec3& center_from_camera, const Eigen::Matrix3d& rotation_covariance);

}  // namespace lodestar
