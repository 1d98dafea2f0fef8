#pragma once

#include <cstdint>

#include "drivers/simulation/image_former.hpp"
#include "maps/marker.hpp"
#include "maps/random.hpp"

// What the frames of `bench localize` show: markers on a plain ceiling, and where the camera stands below
// them.
namespace lodestar {

/// One point of a sweep. As it stands: the paper's camera 2.6 m below one marker, right under it, good light.
struct BenchScene {
  double noise_gray = 4.0;  ///< of every pixel, whatever its light
  double blur_sigma_px = 0.5;
  double height_m = 2.6;    ///< of the ceiling above the camera
  double tilt_rad = 0.0;    ///< of the camera, to a random side; it looks at the marker all the same
  double light = 1.0;       ///< share of the usual light
  double covered = 0.0;     ///< share of the marker's side that something hides, from a random side
  double off_axis_m = 0.0;  ///< how far the marker is aside of where the camera looks, along the image's rows
  double texture_gray = 6.0;  ///< amplitude of the ceiling's texture
  int markers = 1;            ///< in view: 1, or 3 in a triangle
};

/// K of Eq. (16).
CameraModel bench_camera();

/// The middle of a marker's grid in the marker frame, and its outer side: from edge to edge of its dots.
inline const Vec3 marker_middle(1.5 * marker_pitch_m, 1.5 * marker_pitch_m, 0.0);
inline constexpr double marker_side_m = (marker_grid_size - 1) * marker_pitch_m + 2.0 * marker_dot_radius_m;

/// Groups of markers, so far apart that one group is in view at a time. Each marker has nine dots, the
/// average number, and another ID.
MarkerRegistry bench_registry(const BenchScene& scene, Random random);

/// The light of the scene: dots and ceiling share it, as paper does (see bench_square_tags).
SimulatedCameraOptions light_of(const BenchScene& scene);

/// Where the camera stands.
struct BenchView {
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d tilt = Eigen::Matrix3d::Identity();  ///< as in PosePrior
  std::size_t first_marker = 0;                        ///< of the group in view
  std::vector<PrintedSquare> covers;
};

/// A random view of a random group.
BenchView some_view(const BenchScene& scene, const MarkerRegistry& registry, Random& random);

}  // namespace lodestar
