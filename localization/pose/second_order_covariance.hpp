#pragma once

#include "maps/geometry.hpp"

// Terms of the covariance of the camera's position (m^2) beyond the linear ones.
namespace lodestar {

/// Second-order term: as its tilt varies the camera swings about the dots on an arc, not on a straight line,
/// and its error across and along the line of sight rotates with it. With p and theta the linear errors of
/// position and rotation, and u the vector from the camera to the dots' centre, the deviation is s = theta x
/// p + theta x (theta x u) / 2, a quadratic form for each coordinate, so that the mean of s s^T follows from
/// the covariance of (p, theta) (Isserlis' theorem for the fourth moments of a Gaussian).
Eigen::Matrix3d arc_covariance(const Vec3& center_from_camera, const Eigen::Matrix<double, 6, 6>& covariance);

/// A scale error of the image acts as a displacement along the optical axis (a unit vector).
Eigen::Matrix3d scale_covariance(const Vec3& center_from_camera, const Vec3& optical_axis,
                                 double scale_sigma);

}  // namespace lodestar
