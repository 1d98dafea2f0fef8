#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "maps/camera_model.hpp"

// The Cramér-Rao lower bound of a pose estimated from dots, as the reference for estimators.
namespace lodestar {

/// A dot at a known point, and the Fisher information of a frame on its centre: 1 / sigma^2 for noise sigma
/// in each coordinate.
struct InformativeDot {
  Vec3 point_in_map = Vec3::Zero();
  Eigen::Matrix2d information_per_px2 = Eigen::Matrix2d::Zero();
};

/// The least covariance that an unbiased estimate can have: of (x_m, y_m, z_m, rotation about the map's x,
/// y, z axes in rad); zero about x and y where the tilt is known.
struct PoseBound {
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();

  [[nodiscard]] double lateral_m() const;  ///< root mean square of the distance in the plane
  [[nodiscard]] double height_m() const;
  [[nodiscard]] double yaw_rad() const;
};

enum class Tilt { known, free };

/// The inverse of the dots' Fisher information on the pose, by the Jacobian of each projection. Nothing when
/// they do not determine the pose, or when one lies behind the camera.
std::optional<PoseBound> cramer_rao_bound(const Eigen::Isometry3d& map_from_camera,
                                          std::span<const InformativeDot> dots, const CameraModel& camera,
                                          Tilt tilt);

}  // namespace lodestar
