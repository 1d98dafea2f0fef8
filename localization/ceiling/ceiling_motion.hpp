#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <vector>

#include "localization/ceiling/ceiling_view.hpp"
#include "localization/ceiling/visual_odometry_increment.hpp"
#include "maps/camera_model.hpp"
#include "maps/frame.hpp"
#include "maps/geometry.hpp"
#include "maps/marker_registry.hpp"

namespace lodestar {

struct CeilingMotionOptions {
  CeilingViewOptions view;
  int cell_px = 16;        ///< points are spread over the reduced image by cells of this side
  int most_in_a_cell = 4;  ///< sharpest points used per cell
  int least_points = 100;
  double least_contrast_gray = 0.4;   ///< standard deviation at the points; below it, too little texture
  double least_correlation = 0.8;     ///< of both frames at the points, once aligned
  double least_share_agreeing = 0.6;  ///< inliers of the points in view; outliers are not on the ceiling
  double least_share_in_view = 0.5;   ///< of the keyframe's points
  double new_keyframe_share_in_view = 0.75;  ///< with fewer of them, a new keyframe is set
  /// Below this mean shift of its points from the keyframe, the ceiling cannot be told from what the camera
  /// carries along, and odometry is as accurate.
  double least_shift_px = 3.0;
  double max_deviation_m = 0.04;  ///< from the prediction; farther off, a false match is likely
  double max_deviation_rad = radians(6.0);
  double sharpness_sigma_px = 0.1;  ///< position uncertainty of a sharp edge between pixels
  double own_sigma_m = 0.0004;      ///< of the method, in addition to noise
  double own_sigma_rad = radians(0.02);
};

/// The markers' common height, if they agree within 5 cm; nothing when they do not, or there are none.
std::optional<double> ceiling_height_m(const MarkerRegistry& registry);

/// Visual odometry on whatever texture the ceiling has besides markers: joints, stains, lamps. Each frame is
/// aligned to a keyframe by a planar motion at the ceiling's height (Lucas and Kanade 1981, by the inverse
/// compositional algorithm of Baker and Matthews 2004) and a small lean, as of a swaying body. Errors do not
/// accumulate while the keyframe is in view. Shadows, and what the camera itself carries along, are rejected
/// as outliers.
class CeilingMotion {
 public:
  /// `lean_sigma_rad`: lean of a swaying body's camera, standard deviation about each of two axes.
  CeilingMotion(const CameraModel& camera, const Eigen::Isometry3d& base_from_camera, double ceiling_height_m,
                double lean_sigma_rad, const CeilingMotionOptions& options = {});

  /// Sets the current frame, CV_8UC1 of the camera's size.
  void set_frame(const Frame& frame);

  /// Makes the current frame the keyframe. False, without a keyframe, where the ceiling has too little
  /// texture.
  bool set_keyframe();

  [[nodiscard]] std::optional<Stamp> keyframe_stamp() const { return keyframe_stamp_; }

  /// True when a robot there sees so little of the keyframe that a new one should be set.
  [[nodiscard]] bool leaves_view(const Pose2& keyframe_from_now) const {
    return overlap(keyframe_from_now).share_in_view < options_.new_keyframe_share_in_view;
  }

  /// Increment from the keyframe to the current frame, near the prediction. Nothing when the shift is too
  /// small or the frames do not match.
  [[nodiscard]] std::optional<VisualOdometryIncrement> motion(const Pose2& expected_keyframe_from_now) const;

  /// Standard deviation of the view's lateral offset on the ceiling, due to sway.
  [[nodiscard]] double sway_m() const { return sway_m_; }

 private:
  /// Shift (m) along x and y, turn (rad) about the base's origin, and lean of the camera (rad) along x and y
  /// with the image centre fixed, which widens the image on one side.
  using Change = Eigen::Matrix<double, 5, 1>;
  /// A point of the keyframe.
  struct Point {
    Vec2 on_ceiling_m;  ///< in the base frame of the keyframe
    Vec2 pixel;
    double gray = 0.0;
    double gray_variance = 0.0;  ///< from the position uncertainty of a sharp edge
    Change gray_by_change;
  };
  /// Alignment of the current frame to the keyframe.
  struct Alignment {
    Pose2 keyframe_from_now;
    Vec2 lean_rad = Vec2::Zero();
  };
  /// The part of the keyframe that is in view.
  struct Overlap {
    double share_in_view = 0.0;
    double shift_px = 0.0;  ///< mean, of the points in view
  };
  struct Sample {
    const Point* point;
    double gray;  ///< in the current frame
  };
  struct Fit {
    Change change;  ///< increment of the alignment
    Eigen::Matrix<double, 5, 5> covariance;
    double share_agreeing = 0.0;
    double correlation = 0.0;
  };

  [[nodiscard]] Overlap overlap(const Pose2& keyframe_from_now) const;
  [[nodiscard]] bool sample(const Alignment& alignment, std::vector<Sample>& seen) const;
  [[nodiscard]] static double noise_of(std::span<const Sample> seen);
  [[nodiscard]] std::optional<Fit> fit(std::span<const Sample> seen, const Vec2& lean_rad) const;
  [[nodiscard]] VisualOdometryIncrement concluded(const Alignment& alignment,
                                                  const Eigen::Matrix3d& covariance_of_shift) const;
  [[nodiscard]] std::optional<Point> point_at(int row, int column) const;
  void choose_points_of_cell(const cv::Rect& cell);

  CeilingView view_;
  double lean_sigma_rad_;
  double sway_m_;
  CeilingMotionOptions options_;
  cv::Mat1f current_;
  Stamp current_at_;
  std::vector<Point> points_;
  std::optional<Stamp> keyframe_stamp_;
};

}  // namespace lodestar
