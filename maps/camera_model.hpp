#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>

#include "maps/geometry.hpp"

namespace lodestar {

enum class Distortion { none, plumb_bob, rational_polynomial, equidistant };

/// A calibrated camera in the OpenCV convention: x right, y down, z along the optical axis; pixel centres
/// have integer coordinates. Coefficients in OpenCV's order: k1 k2 p1 p2 k3 k4 k5 k6, or k1..k4
/// (equidistant).
struct CameraModel {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  Distortion distortion = Distortion::none;
  std::array<double, 8> coefficients{};
  /// Square of the widest ray's length in the plane z = 1: beyond it the distortion folds back, and rays
  /// would show where others do. Unlimited until limit_rays() has been called, as load_camera and fit_lens
  /// do.
  double widest_ray_squared = std::numeric_limits<double>::infinity();

  /// Sets widest_ray_squared; call again whenever the coefficients change.
  void limit_rays();

  /// Image point of a point in the camera frame; empty behind the camera (z <= 0) and beyond the widest ray.
  [[nodiscard]] std::optional<Vec2> project(const Vec3& point_in_camera) const;

  /// Image point of the ray (x, y, 1), also beyond the widest one.
  [[nodiscard]] Vec2 distorted(const Vec2& normalized) const;

  /// Jacobian of distorted(), in pixels per unit of the ray.
  [[nodiscard]] Eigen::Matrix2d distorted_jacobian(const Vec2& normalized) const;

  /// The inverse of distorted(): x and y of the ray (x, y, 1) through a pixel (Newton's method). Empty where
  /// the distortion cannot be inverted, and beyond the widest ray.
  [[nodiscard]] std::optional<Vec2> normalized(const Vec2& pixel) const;

  [[nodiscard]] bool contains(const Vec2& pixel, double margin_px = 0.0) const;
};

/// Reads a ROS camera_info YAML file, or an OpenCV FileStorage one (`%YAML:1.0`). Throws InputError.
CameraModel load_camera(const std::filesystem::path& file);

/// Writes a ROS camera_info YAML file atomically; load_camera reads the same model back, bit for bit. `name`
/// becomes camera_name. Throws InputError when it cannot be written.
void save_camera(const CameraModel& camera, const std::string& name, const std::filesystem::path& file);

}  // namespace lodestar
