#pragma once

#include <ceres/cost_function.h>
#include <ceres/sized_cost_function.h>

#include "localization/survey/survey_state.hpp"
#include "maps/anchors.hpp"

// Residuals of the survey, all in standard deviations.
namespace lodestar {

/// Reprojection errors of one marker's dots in one keyframe. Parameters: place, marker, mount position, mount
/// turn, print scale and k1, dot offsets.
class DotsOfSighting : public ceres::CostFunction {
 public:
  /// Keeps references to the camera and the belief.
  DotsOfSighting(const KeyframeSighting& sighting, const SeenCells& cells, const CameraModel& camera,
                 const SurveyBelief& belief, const SurveyOptions& options);

  /// False when a dot is behind the camera.
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override;

 private:
  struct Seen {
    Vec2 cell_m;  ///< in the marker's plane
    int at = 0;   ///< of its offset
    Vec2 pixel;
    double weight = 0.0;
  };
  const CameraModel& camera_;
  const SurveyBelief& belief_;
  std::vector<Seen> dots_;
};

/// Motion between two keyframes less what the wheels report, in reported metres: in ground metres a smaller
/// world would have smaller residuals. Parameters: both places, the wheels.
class WheelsBetween : public ceres::SizedCostFunction<3, 5, 5, 3> {
 public:
  /// Keeps a reference to the segment. The noise is propagated with this gauge.
  WheelsBetween(const WheelSegment& segment, const WheelGauge& gauge, const WheelNoise& noise);
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override;

 private:
  const WheelSegment& segment_;
  Eigen::Matrix3d root_information_;
};

/// Motion between two keyframes less the ceiling's own, corrected for where the camera sits on the base; in
/// metres at the believed height, for the reason of WheelsBetween. Parameters: both places, the ceiling's
/// scale, mount position, mount turn, print scale and k1: by the print the ceiling is as high as it is, and a
/// lean sways its picture by as much in a smaller world.
class CeilingBetween : public ceres::SizedCostFunction<3, 5, 5, 1, 3, 3, 2> {
 public:
  /// `believed_mount_m`: with which the motion was computed; `ceiling_m`: as high as by a nominal print. A
  /// camera that is tilted, by its mount or by the body's lean, looks at a place aside: both at the ceiling's
  /// texture and at markers on it.
  CeilingBetween(const CeilingSegment& segment, const Vec3& believed_mount_m, double ceiling_m);
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override;

 private:
  Vec2 camera_way_m_;  ///< of the camera, in the base's axes as believed
  double turn_rad_;
  double ceiling_m_;       ///< above the floor, where the body turns when it leans
  double above_camera_m_;  ///< where the camera turns on its mount
  Eigen::Matrix3d root_information_;
};

/// The entries of a parameter block of `size` from `first` on, near `mean`, with a standard deviation for
/// each.
class Near : public ceres::CostFunction {
 public:
  Near(int size, int first, Eigen::VectorXd mean, const Eigen::VectorXd& sigmas);
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override;

 private:
  int size_;
  int first_;
  Eigen::VectorXd mean_;
  Eigen::VectorXd weights_;
};

/// A point and, if given, a heading carried by x, y, yaw at `yaw_at` of a block of `size`: a marker's or a
/// robot's anchor. `way_m` is from the block's pose to the point, in its frame.
class PoseNear : public ceres::CostFunction {
 public:
  struct Known {
    Vec2 position_m;
    double sigma_m = 0.0;
    std::optional<AnchorYaw> yaw;
    Pose2 from_block;  ///< what was measured, as seen from the block's pose
  };
  PoseNear(const Known& known, int size, int yaw_at);
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override;

 private:
  Known known_;
  int size_;
  int yaw_at_;
};

/// The distance between the dots O of two markers.
class MarkersApart : public ceres::SizedCostFunction<1, 6, 6> {
 public:
  MarkersApart(double distance_m, double sigma_m) : distance_m_(distance_m), sigma_m_(sigma_m) {}
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override;

 private:
  double distance_m_;
  double sigma_m_;
};

}  // namespace lodestar
