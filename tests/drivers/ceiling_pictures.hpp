#pragma once

#include <cmath>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "drivers/simulation/simulated_camera_options.hpp"
#include "maps/camera_model.hpp"
#include "maps/marker.hpp"
#include "maps/marker_registry.hpp"
#include "maps/random.hpp"

// Cameras, ceilings and image measurements that the tests of the simulated camera share.
namespace lodestar::testing {

/// 90 degrees wide, for a ceiling 1.5 m above it.
inline CameraModel wide_camera() {
  return {640, 480, 320.0, 320.0, 319.5, 239.5, Distortion::none, {}};
}

inline CameraModel distorted(CameraModel camera) {
  camera.distortion = Distortion::plumb_bob;
  camera.coefficients = {-0.12, 0.02, 0.0008, -0.0005, 0.0};
  return camera;
}

inline MarkerRegistry one_marker(int id, const Vec3& position_m, double yaw_rad = 0.0) {
  MarkerRegistry registry;
  registry.markers = {{id, position_m, yaw_rad, 0}};
  return registry;
}

/// Markers with random IDs and directions on a grid around the origin, `spacing_m` apart.
inline MarkerRegistry many_markers(double height_m, double spacing_m, std::uint64_t seed) {
  Random random(seed);
  MarkerRegistry registry;
  for (int i = -4; i <= 4; ++i) {
    for (int j = -4; j <= 4; ++j) {
      const auto id = static_cast<int>(random.below(marker_id_count));
      const double yaw = random.uniform(-std::numbers::pi, std::numbers::pi);
      registry.markers.push_back({id, {i * spacing_m, j * spacing_m, height_m}, yaw, 0});
    }
  }
  return registry;
}

/// Only dots on an even ceiling, without noise.
inline SimulatedCameraOptions plain_light() {
  SimulatedCameraOptions options;
  options.dot_gray_sigma = 0.0;
  options.dot_place_sigma_m = 0.0;
  options.read_noise_gray = 0.0;
  options.shot_noise_gray_at_255 = 0.0;
  options.vignetting = 0.0;
  options.texture_gray = 0.0;
  options.tubes = options.lamps = options.glints = false;
  return options;
}

inline Eigen::Isometry3d camera_at(double x_m, double y_m, double z_m, const RollPitchYaw& angles) {
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
  map_from_camera.translation() << x_m, y_m, z_m;
  map_from_camera.linear() = rotation_from(angles);
  return map_from_camera;
}

/// Centroid of the light above the background within `half_px` of a point, and its covariance.
struct Spot {
  Vec2 center_px = Vec2::Zero();
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Zero();
  double light = 0.0;
};

inline Spot measure_spot(const cv::Mat& gray, const Vec2& near_px, int half_px, double background_gray) {
  const auto u0 = static_cast<int>(std::lround(near_px.x()));
  const auto v0 = static_cast<int>(std::lround(near_px.y()));
  Spot spot;
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (int v = v0 - half_px; v <= v0 + half_px; ++v) {
    for (int u = u0 - half_px; u <= u0 + half_px; ++u) {
      const double light = gray.at<std::uint8_t>(v, u) - background_gray;
      spot.light += light;
      spot.center_px += light * Vec2(u, v);
      second += light * Vec2(u, v) * Vec2(u, v).transpose();
    }
  }
  spot.center_px /= spot.light;
  spot.covariance_px2 = second / spot.light - spot.center_px * spot.center_px.transpose();
  return spot;
}

}  // namespace lodestar::testing
