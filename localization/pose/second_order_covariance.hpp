#pragma once

#include "maps/geometry.hpp"

// What the covariance of the camera's place (m^2) has beside that of the linear view.
namespace lodestar {

/// What the linear view leaves out of the covariance: with its tilt in doubt the camera swings about the dots
/// on an arc, not on a straight line, and what it is off across or along the line of sight turns with it.
/// With p and theta the errors of place and rotation in the linear view, and u the way from the camera to the
/// dots' centre, it leaves that view by s = theta x p + theta x (theta x u) / 2, a quadratic form for each
/// coordinate, so that the mean of s s^T follows from the covariance of (p, theta) (Isserlis' theorem for the
/// fourth moments of a Gaussian).
Eigen::Matrix3d arc_covariance(const Vec3& center_from_camera, const Eigen::Matrix<double, 6, 6>& covariance);

/// A picture that is too large or too small by a share looks as if taken from nearer or farther along the
/// optical axis (a unit vector).
Eigen::Matrix3d scale_covariance(const Vec3& center_from_camera, const Vec3& optical_axis,
                                 double scale_sigma);

}  // namespace lodestar
