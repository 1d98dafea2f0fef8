#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "localization/pose/pose_fix.hpp"
#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// As PoseByOffset, of (x_m, y_m, yaw_rad).
struct PlanarByOffset {
  int id = 0;
  Eigen::Matrix<double, 3, 5> jacobian;
};

/// Robot pose from one camera fix. Covariances are of (x_m, y_m, yaw_rad) in the map frame.
struct PlanarFix {
  Stamp stamp;
  Pose2 map_from_base;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d shared_covariance = Eigen::Matrix3d::Zero();  ///< the part of it that nearby fixes share
  std::vector<PlanarByOffset> by_offsets;                       ///< of which that consists, among others
  std::vector<int> ids;                                         ///< of the markers used
};

/// Mount compensation, Eq. (17) for any mount: map_from_base = map_from_camera * camera_from_base. With the
/// camera r ahead on the x axis this is x_r = x_t - r cos(theta), y_r = y_t - r sin(theta).
PlanarFix compensate_mount(const PoseFix& fix, const Eigen::Isometry3d& base_from_camera);

struct Circle {
  Vec2 center_m = Vec2::Zero();
  double radius_m = 0.0;
};

/// Least-squares circle through the points: the camera's path while the robot spins on the spot, whose radius
/// is the r of Eq. (17). Nothing for fewer than three points or collinear points.
std::optional<Circle> fit_circle(const std::vector<Vec2>& points);

}  // namespace lodestar
