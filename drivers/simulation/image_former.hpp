#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <utility>
#include <variant>
#include <vector>

#include "drivers/simulation/ceiling.hpp"
#include "drivers/simulation/ceiling_background.hpp"
#include "drivers/simulation/ceiling_surface.hpp"
#include "drivers/simulation/disc_profile.hpp"
#include "drivers/simulation/light_image.hpp"
#include "drivers/simulation/printed_square.hpp"
#include "drivers/simulation/sensor_noise.hpp"
#include "drivers/simulation/simulated_camera_options.hpp"
#include "drivers/simulation/vignetting.hpp"
#include "maps/camera_model.hpp"
#include "maps/marker_registry.hpp"

namespace lodestar {

/// A marker's dot in view.
struct SeenDot {
  std::size_t marker = 0;  ///< index in the registry
  Vec3 center_in_map_m = Vec3::Zero();
  Vec2 center_px = Vec2::Zero();  ///< centroid of its light
  /// Fisher information of one frame's pixels on the centre, 1/px^2.
  Eigen::Matrix2d information_per_px2 = Eigen::Matrix2d::Zero();
};

/// Renders the camera image of the ceiling: background with texture and lights, marker dots as blurred
/// ellipses with motion blur, then noise and 8-bit quantization. Seed, poses and frame number determine every
/// byte, independent of frames rendered before. Not thread-safe.
class ImageFormer {
 public:
  ImageFormer(const MarkerRegistry& registry, const CameraModel& camera,
              const SimulatedCameraOptions& options, std::uint64_t seed);

  /// One frame (CV_8UC1) of a shutter that opens at the first pose and closes at the second; with equal poses
  /// there is no motion blur. The frame number determines the noise.
  cv::Mat expose(const Eigen::Isometry3d& map_from_camera_at_opening,
                 const Eigen::Isometry3d& map_from_camera_at_closing, std::uint64_t frame_number);

  /// Adds a printed square to the ceiling, drawn below lamps, glints and markers. It shows no motion blur.
  void add(const PrintedSquare& square) { squares_.push_back(square); }

  /// Replaces the covers that hide markers.
  void cover(std::vector<PrintedSquare> covers) { covers_ = std::move(covers); }

  /// Replaces the markers, and the lamps in addition to the ceiling's own.
  void rehang(std::vector<CeilingMarker> markers, std::vector<CeilingDisc> more_lamps) {
    ceiling_.markers = std::move(markers);
    more_lamps_ = std::move(more_lamps);
  }

  /// Removes the markers and leaves the rest of the ceiling as it is.
  void take_markers_down() { ceiling_.markers.clear(); }

  /// The dots entirely in view of a stationary camera, covered or not.
  [[nodiscard]] std::vector<SeenDot> dots_in_view(const Eigen::Isometry3d& map_from_camera) const;

 private:
  struct Shutter;  ///< the camera's poses during one exposure

  void paint_tube(const CeilingTube& tube, const Shutter& shutter);
  void paint_disc(const CeilingDisc& disc, double gray, const Shutter& shutter);
  void paint_markers(const Shutter& shutter);
  void paint_squares(const std::vector<PrintedSquare>& squares, const Shutter& shutter);

  /// True when the point in the camera frame lies within the cone of rays that the image shows.
  [[nodiscard]] bool may_show(const Vec3& point_in_camera, double reach_m) const;
  /// Gray value at a dot's centre: retroreflected light of the ring, passed through the sensor's saturation
  /// curve.
  [[nodiscard]] double dot_gray(const CeilingDisc& dot, const Shutter& shutter) const;

  CameraModel camera_;
  SimulatedCameraOptions options_;
  Ceiling ceiling_;
  std::vector<PrintedSquare> squares_;
  std::vector<PrintedSquare> covers_;
  std::vector<CeilingDisc> more_lamps_;
  Vignetting vignetting_;
  double blur_sigma_px_;  ///< lens and pixel together
  double widest_ray_;     ///< largest hypot(x, y) of the rays (x, y, 1) in the image
  DiscProfile profile_;
  std::variant<CeilingBackground, CeilingSurface> background_;
  SensorNoise noise_;
  LightImage light_;  ///< kept between frames only to reuse its memory
};

}  // namespace lodestar
