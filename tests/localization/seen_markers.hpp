#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "localization/detection/detected_marker.hpp"
#include "localization/pose/pose_fix.hpp"
#include "maps/random.hpp"

// Three markers on a ceiling, and a detector's output for them at a known pose.
namespace lodestar {

using Vec6 = Eigen::Matrix<double, 6, 1>;

inline MarkerRegistry ceiling() {
  MarkerRegistry registry;
  registry.markers.push_back({447, Vec3(1.0, 2.0, 2.6), radians(20.0), 0});
  registry.markers.push_back({1782, Vec3(1.5, 2.1, 2.6), radians(-70.0), 0});
  registry.markers.push_back({3003, Vec3(1.2, 1.6, 2.6), radians(170.0), 0});
  return registry;
}

inline Eigen::Isometry3d view_from(const Vec3& position, double yaw_rad, double roll_rad = 0.0,
                                   double pitch_rad = 0.0) {
  Eigen::Isometry3d view = Eigen::Isometry3d::Identity();
  view.linear() = rotation_from({0.0, 0.0, yaw_rad}) * rotation_from({roll_rad, pitch_rad, 0.0});
  view.translation() = position;
  return view;
}

/// A detector's output for these markers, each tilted about dot O by the sigma that it may have, with noise
/// on the dots' centres.
inline std::vector<DetectedMarker> seen(const Eigen::Isometry3d& view, const MarkerRegistry& registry,
                                        const CameraModel& camera, double noise_px, Random& random) {
  std::vector<DetectedMarker> markers;
  for (const RegisteredMarker& registered : registry.markers) {
    DetectedMarker marker;
    marker.id = registered.id;
    marker.confidence = 0.9;
    const double tilt_sigma_rad = registered.sigma.value_or(MarkerSigma{}).tilt_rad;
    Eigen::Isometry3d map_from_tilted = map_from_marker(registry, registered);
    if (tilt_sigma_rad > 0.0)
      map_from_tilted.linear() =
          rotation_from({tilt_sigma_rad * random.normal(), tilt_sigma_rad * random.normal(), 0.0}) *
          map_from_tilted.linear();
    for (const GridCell cell : dots_of(registered.id)) {
      const Vec2 in_marker = cell_in_marker(cell);
      const Vec3 in_map = map_from_tilted * Vec3(in_marker.x(), in_marker.y(), 0.0);
      const Vec2 pixel =
          *camera.project(view.inverse() * in_map) + noise_px * Vec2(random.normal(), random.normal());
      marker.dots.push_back({cell, pixel});
      if (cell == cell_of_o) marker.o_px = pixel;
      if (cell == cell_of_x) marker.x_px = pixel;
      if (cell == cell_of_y) marker.y_px = pixel;
    }
    markers.push_back(marker);
  }
  return markers;
}

/// The estimate's error in the coordinates of its covariance.
inline Vec6 error_of(const PoseFix& fix, const Eigen::Isometry3d& truth) {
  Vec6 error;
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(truth.linear() * fix.map_from_camera.linear().transpose()));
  error << truth.translation() - fix.map_from_camera.translation(), turn.angle() * turn.axis();
  return error;
}

}  // namespace lodestar
