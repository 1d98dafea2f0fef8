#pragma once

#include <Eigen/Core>
#include <span>

#include "maps/geometry.hpp"
#include "maps/marker_registry.hpp"

namespace lodestar {

/// A point in two frames.
struct PointPair {
  Vec2 from_m;
  Vec2 to_m;
  double weight = 1.0;
};

/// The rigid motion that takes `from_m` nearest to `to_m`: weighted least squares (Umeyama 1991, without
/// scale). Points that are one do not tell its turn: it is `turn_rad` then.
Pose2 best_rigid_motion(std::span<const PointPair> pairs, double turn_rad = 0.0);

/// Changes of (x, y, yaw) of each marker when the registry moves along x, along y and turns about its middle:
/// 3 n x 3.
Eigen::MatrixXd rigid_motions(std::span<const RegisteredMarker> markers);

/// Projection of (x, y, yaw) changes that takes the best rigid motion of the positions out of them
/// (S-transform of Baarda 1973): 3 n x 3 n.
Eigen::MatrixXd without_rigid_motion(std::span<const RegisteredMarker> markers);

/// Standard deviation of the registry's turn as a whole, for this covariance of (x, y, yaw).
double turn_sigma_rad(std::span<const RegisteredMarker> markers, const Eigen::MatrixXd& covariance);

}  // namespace lodestar
