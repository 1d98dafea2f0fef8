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
  int cell_px = 16;        ///< points are spread over the reduced picture by cells of this side,
  int most_in_a_cell = 4;  ///< the sharpest so many of each
  int least_points = 100;
  double least_contrast_gray = 0.4;  ///< standard deviation at the points; less is a plain ceiling
  double least_correlation = 0.8;    ///< of both pictures at the points, when they alignment upon each other,
  double least_share_agreeing = 0.6;  ///< at so many of those in view or more; the others are no ceiling
  double least_share_in_view = 0.5;   ///< of the kept picture's points
  double new_keyframe_share_in_view = 0.75;  ///< with fewer than these a new picture is kept
  /// Nearer to the kept picture than this (mean over its points) nobody can tell the ceiling from what the
  /// camera carries along, and wheels know as much.
  double least_shift_px = 3.0;
  double max_deviation_m = 0.04;  ///< from what was expected; farther away something else looks alike
  double max_deviation_rad = radians(6.0);
  double sharpness_sigma_px = 0.1;  ///< a sharp edge between pixels is not known better than to this
  double own_sigma_m = 0.0004;      ///< of the method, besides noise
  double own_sigma_rad = radians(0.02);
};

/// The height at which all markers hang, within 5 cm; nothing when they don't, or there are none.
std::optional<double> ceiling_height_m(const MarkerRegistry& registry);

/// How the robot moves under whatever can be seen of the ceiling besides markers: joints, stains, lamps. A
/// picture of it is kept, and each later one laid over it so that both agree best, moved and turned on a
/// plane at the ceiling's height (Lucas and Kanade 1981, by the inverse compositional algorithm of Baker and
/// Matthews 2004), and leaning a little, as a body that sways makes it. So errors don't add up as long as the
/// kept picture is in view. What the camera itself carries along, or a shadow, is outvoted.
class CeilingMotion {
 public:
  /// `lean_sigma_rad`: of a swaying body's camera, about each of two axes.
  CeilingMotion(const CameraModel& camera, const Eigen::Isometry3d& base_from_camera, double ceiling_height_m,
                double lean_sigma_rad, const CeilingMotionOptions& options = {});

  /// From now on this is the current picture. CV_8UC1 of the camera's size.
  void set_frame(const Frame& frame);

  /// Keeps the current picture. False, and nothing is kept any more, where the ceiling is too plain.
  bool set_keyframe();

  [[nodiscard]] std::optional<Stamp> keyframe_stamp() const { return keyframe_stamp_; }

  /// Would a robot there see so little of the kept picture that another should be kept?
  [[nodiscard]] bool leaves_view(const Pose2& keyframe_from_now) const {
    return overlap(keyframe_from_now).share_in_view < options_.new_keyframe_share_in_view;
  }

  /// From the kept picture to the current one, near to what is expected. Nothing where these do not show the
  /// same.
  [[nodiscard]] std::optional<VisualOdometryIncrement> motion(const Pose2& expected_keyframe_from_now) const;

  /// Standard deviation of how far a swaying body's camera sees itself aside.
  [[nodiscard]] double sway_m() const { return sway_m_; }

 private:
  /// A shift (m) along x and y and a turn (rad) about the base's origin, and a camera that leans (rad) along
  /// x and y while the middle of its picture stays: then the picture is wider on one side.
  using Change = Eigen::Matrix<double, 5, 1>;
  /// A point of the kept picture.
  struct Point {
    Vec2 on_ceiling_m;  ///< in the base frame of then
    Vec2 pixel;
    double gray = 0.0;
    double gray_variance = 0.0;  ///< by what is not known of a sharp edge
    Change gray_by_change;
  };
  /// How the current picture lies upon the kept one.
  struct Alignment {
    Pose2 keyframe_from_now;
    Vec2 lean_rad = Vec2::Zero();
  };
  /// What the current picture has of the kept one.
  struct Overlap {
    double share_in_view = 0.0;
    double shift_px = 0.0;  ///< mean, of those points
  };
  struct Sample {
    const Point* point;
    double gray;  ///< of the current picture
  };
  struct Fit {
    Change change;  ///< of the kept picture, so that both agree better
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
