#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "maps/camera_model.hpp"

// How well a pose can be told from dots at all: the bound of Cramér and Rao, by which estimates are judged.
namespace lodestar {

/// A dot whose place on the ceiling is known, and what a frame tells of its centre: Fisher's information,
/// which is 1 / sigma^2 for a centre with noise sigma in each coordinate.
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

/// The inverse of the information that the dots have on the pose, each through the derivative of its
/// projection. Nothing when they do not determine the pose, or when one lies behind the camera.
std::optional<PoseBound> cramer_rao_bound(const Eigen::Isometry3d& map_from_camera,
                                          std::span<const InformativeDot> dots, const CameraModel& camera,
                                          Tilt tilt);

}  // namespace lodestar
