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

/// A rigid motion and a scale about a point: where two measures of length differ.
struct SimilarMotion {
  Pose2 motion;
  Vec2 middle_m = Vec2::Zero();  ///< what the scale leaves in its place
  double scale = 1.0;
  [[nodiscard]] Vec2 operator*(const Vec2& point_m) const {
    return motion * Vec2(middle_m + scale * (point_m - middle_m));
  }
};

/// The same with a scale that is 1 with this standard deviation; weights are 1 / m^2.
SimilarMotion best_similar_motion(std::span<const PointPair> pairs, double scale_sigma);

/// Changes of (x, y, yaw) of each marker when the registry moves along x, along y and turns about its middle:
/// 3 n x 3.
Eigen::MatrixXd rigid_motions(std::span<const RegisteredMarker> markers);

/// The covariance of (x, y, yaw) of each marker without the best rigid motion of the positions and without
/// `scale_share` (0 to 1) of their best scale: that of the shape (S-transform of Baarda 1973).
Eigen::MatrixXd shape_covariance(std::span<const RegisteredMarker> markers, const Eigen::MatrixXd& covariance,
                                 double scale_share = 0.0);

/// Standard deviation of the registry's turn as a whole, for this covariance of (x, y, yaw).
double turn_sigma_rad(std::span<const RegisteredMarker> markers, const Eigen::MatrixXd& covariance);

}  // namespace lodestar
