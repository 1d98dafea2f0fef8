#pragma once

#include "maps/geometry.hpp"

// Rotations as vectors: the axis, with the angle in radians as its length.
namespace lodestar {

Eigen::Matrix3d rotation_by(const Vec3& vector);

/// Matrix of the cross product with `v` from the left.
Eigen::Matrix3d skew(const Vec3& v);

/// Left Jacobian of SO(3): rotation about the fixed axes, per change of `vector`.
Eigen::Matrix3d turn_by_vector(const Vec3& vector);

}  // namespace lodestar
