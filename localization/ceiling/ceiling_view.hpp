#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "maps/camera_model.hpp"
#include "maps/geometry.hpp"

namespace lodestar {

struct CeilingViewOptions {
  int halvings = 2;                ///< of a frame's size, before anything is compared
  double contrast_reach_px = 8.0;  ///< brightness that changes more slowly than over this is the light's
  double farthest_m = 3.0;         ///< aside of the camera a point of the ceiling is too oblique
};

/// The frame, reduced and cleared of what changes slowly: a vignette and the glow beside a lamp.
cv::Mat1f contrasts(const cv::Mat& gray, const CeilingViewOptions& options);

/// Does the pixel lie between four of the picture's?
bool is_within(const cv::Mat1f& picture, const Vec2& pixel);

/// Bilinear, of a pixel that is within the picture.
double gray_at(const cv::Mat1f& picture, const Vec2& pixel);

/// How the camera of a level robot sees a ceiling at one height: from pixels of the reduced picture to points
/// (x_m, y_m) in the base frame, and back.
class CeilingView {
 public:
  CeilingView(const CameraModel& camera, const Eigen::Isometry3d& base_from_camera, double ceiling_height_m,
              const CeilingViewOptions& options);

  /// Nothing behind the camera.
  [[nodiscard]] std::optional<Vec2> pixel_of(const Vec2& on_ceiling_m) const;

  /// Nothing for a ray that does not meet the ceiling, or too far away.
  [[nodiscard]] std::optional<Vec2> ceiling_at(const Vec2& pixel) const;

  /// How far a point seems to be shifted when the camera leans along x and y (rad), beyond what shifts the
  /// middle of the picture: on the side to which it leans the picture becomes wider.
  [[nodiscard]] Eigen::Matrix2d shift_by_lean(const Vec2& on_ceiling_m) const;

 private:
  CameraModel camera_;
  Eigen::Isometry3d base_from_camera_;
  Eigen::Isometry3d camera_from_base_;
  double height_m_;   ///< of the ceiling in the base frame
  double reduction_;  ///< so many pixels of a frame, across and down, become one
  double farthest_m_;
};

}  // namespace lodestar
