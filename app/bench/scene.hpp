#pragma once

#include <cstdint>

#include "drivers/simulation/image_former.hpp"
#include "maps/marker.hpp"
#include "maps/random.hpp"

// The scenes of `bench localize`: markers on a plain ceiling, and the camera's pose below them.
namespace lodestar {

/// One point of a sweep. Default: the paper's camera 2.6 m directly below one marker, in good light.
struct BenchScene {
  double noise_gray = 4.0;  ///< of every pixel, independent of its brightness
  double blur_sigma_px = 0.5;
  double height_m = 2.6;      ///< of the ceiling above the camera
  double tilt_rad = 0.0;      ///< of the camera, in a random direction; it still looks at the marker
  double light = 1.0;         ///< share of the usual light
  double covered = 0.0;       ///< share of the marker's side that is occluded, from a random side
  double off_axis_m = 0.0;    ///< distance of the marker from the optical axis, along the image's rows
  double texture_gray = 6.0;  ///< amplitude of the ceiling's texture
  bool megapixel = false;     ///< 1280 x 1024 pixels of half the size in place of the paper's 640 x 480
  int markers = 1;            ///< in view: 1, or 3 in a triangle
};

/// The paper's.
CameraModel bench_camera();

/// The paper's, or one with the same lens and four times as many pixels.
CameraModel camera_of(const BenchScene& scene);

/// The centre of a marker's grid in the marker frame, and its outer side length, between the outer edges of
/// its dots.
inline const Vec3 marker_middle(1.5 * marker_pitch_m, 1.5 * marker_pitch_m, 0.0);
inline constexpr double marker_side_m = (marker_grid_size - 1) * marker_pitch_m + 2.0 * marker_dot_radius_m;

/// Groups of markers, far enough apart that only one is in view at a time. Each marker has nine dots, the
/// average number, and an ID of its own.
MarkerRegistry bench_registry(const BenchScene& scene, Random random);

/// The light of the scene, common to dots and ceiling, and to the paper of square_tags.cpp.
SimulatedCameraOptions light_of(const BenchScene& scene);

/// A camera pose, and what occludes its view.
struct BenchView {
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d tilt = Eigen::Matrix3d::Identity();  ///< as in PosePrior
  std::size_t first_marker = 0;                        ///< of the group in view
  std::vector<PrintedSquare> covers;
};

/// A random view of a random group.
BenchView some_view(const BenchScene& scene, const MarkerRegistry& registry, Random& random);

}  // namespace lodestar
