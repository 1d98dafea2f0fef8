#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "maps/camera_model.hpp"
#include "maps/geometry.hpp"

namespace lodestar {

struct CeilingViewOptions {
  int halvings = 2;                ///< of a frame's size, before any comparison
  double contrast_reach_px = 8.0;  ///< brightness that changes more slowly than over this is illumination
  double farthest_m = 3.0;         ///< points of the ceiling farther aside of the camera are too oblique
};

/// The frame, reduced and without slow changes of brightness: vignette, glow beside a lamp.
cv::Mat1f contrasts(const cv::Mat& gray, const CeilingViewOptions& options);

/// True when the pixel lies between four pixels of the picture.
bool is_within(const cv::Mat1f& picture, const Vec2& pixel);

/// Bilinear interpolation at a pixel within the picture.
double gray_at(const cv::Mat1f& picture, const Vec2& pixel);

/// Projection of a level robot's camera onto a ceiling at one height: from pixels of the reduced image to
/// points (x_m, y_m) in the base frame, and back.
class CeilingView {
 public:
  CeilingView(const CameraModel& camera, const Eigen::Isometry3d& base_from_camera, double ceiling_height_m,
              const CeilingViewOptions& options);

  /// Nothing behind the camera.
  [[nodiscard]] std::optional<Vec2> pixel_of(const Vec2& on_ceiling_m) const;

  /// Nothing for a ray that does not meet the ceiling, or only beyond `farthest_m`.
  [[nodiscard]] std::optional<Vec2> ceiling_at(const Vec2& pixel) const;

  /// Apparent shift of a point per lean of the camera along x and y (rad), beyond the shift of the image
  /// centre: the image widens on the side of the lean.
  [[nodiscard]] Eigen::Matrix2d shift_by_lean(const Vec2& on_ceiling_m) const;

 private:
  CameraModel camera_;
  Eigen::Isometry3d base_from_camera_;
  Eigen::Isometry3d camera_from_base_;
  double height_m_;   ///< of the ceiling in the base frame
  double reduction_;  ///< frame pixels per reduced pixel, across and down
  double farthest_m_;
};

}  // namespace lodestar
