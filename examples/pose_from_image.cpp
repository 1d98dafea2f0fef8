// Where was the camera that took this picture of the ceiling?
//   pose_from_image markers.yaml camera.yaml picture.png
// Prints its position in the map in metres, its heading in degrees, and how far off both may be.
#include <cmath>
#include <cstdio>
#include <exception>

#include "localization/detection/marker_detector.hpp"
#include "localization/pose/pose_fix.hpp"
#include "maps/camera_model.hpp"
#include "maps/marker_registry.hpp"
#include "maps/picture.hpp"

int main(int argc, char** argv) try {
  if (argc != 4) {
    std::fprintf(stderr, "usage: pose_from_image markers.yaml camera.yaml picture.png\n");
    return 2;
  }
  const lodestar::MarkerRegistry registry = lodestar::load_registry(argv[1]);
  const lodestar::CameraModel camera = lodestar::load_camera(argv[2]);
  const cv::Mat gray = lodestar::gray_picture_in(argv[3]);

  lodestar::MarkerDetector detector(lodestar::expecting(registry));
  const auto markers = detector.detect(gray);
  const auto fix = lodestar::fix_pose(lodestar::Stamp{}, markers, registry, camera, {});
  if (!fix) {
    std::printf("no pose: %zu markers read\n", markers.size());
    return 1;
  }

  const auto position_m = fix->map_from_camera.translation();
  const auto axis_x = fix->map_from_camera.linear().col(0);
  constexpr double degrees = 180.0 / 3.14159265358979323846;
  std::printf("x %.4f m, y %.4f m, z %.4f m, yaw %.3f degrees; sigma of x %.4f m, of yaw %.3f degrees\n",
              position_m.x(), position_m.y(), position_m.z(), degrees * std::atan2(axis_x.y(), axis_x.x()),
              std::sqrt(fix->covariance(0, 0)), degrees * std::sqrt(fix->covariance(5, 5)));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
