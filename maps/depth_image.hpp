#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "maps/camera_model.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// One image of a depth camera.
struct DepthImage {
  Stamp stamp;       ///< of mid-exposure
  cv::Mat depth_mm;  ///< CV_16UC1: along the optical axis; 0 where nothing is known
};

/// A depth camera on the robot.
struct DepthMount {
  CameraModel camera;                                                  ///< rectified: without distortion
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();  ///< x right, y down, z ahead
  double range_m = 4.0;  ///< farther away its depth is not to be relied on
};

}  // namespace lodestar
