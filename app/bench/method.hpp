#pragma once

#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "drivers/simulation/image_former.hpp"
#include "maps/camera_model.hpp"
#include "maps/marker_registry.hpp"

namespace lodestar {

/// A marker as read by a method.
struct ReadMarker {
  int id = 0;
  Vec2 center_px = Vec2::Zero();
  std::optional<double> probability;  ///< that the ID is right, as stated by the method
};

/// A method's result for one frame.
struct MethodResult {
  std::vector<ReadMarker> markers;
  std::optional<Eigen::Isometry3d> upright;  ///< map_from_camera with known tilt
  std::optional<Eigen::Isometry3d> free;     ///< map_from_camera without prior
  double microseconds = 0.0;                 ///< from the frame to the first pose, one thread
};

/// A localization method under test in `bench localize`. Not thread-safe.
class BenchMethod {
 public:
  virtual ~BenchMethod() = default;

  /// Replaces the registry's markers on the ceiling by the method's own, at the same poses, and prepares it
  /// to expect them.
  virtual void install(const MarkerRegistry& registry, const CameraModel& camera, ImageFormer& former) = 0;

  /// The ID at the pose of the registry's i-th marker.
  [[nodiscard]] virtual int id_at(const MarkerRegistry& registry, std::size_t i) const = 0;

  /// Is it timed as the minimum of several runs? Pointless for methods that take milliseconds.
  [[nodiscard]] virtual bool is_quick() const { return false; }
  virtual std::vector<ReadMarker> read(const cv::Mat& gray) = 0;

  /// Reads the markers and estimates the pose. `tilt` is as in PosePrior.
  virtual MethodResult run(const cv::Mat& gray, const MarkerRegistry& registry, const CameraModel& camera,
                           const Eigen::Matrix3d& tilt) = 0;
};

/// A method with settings, and how to construct it.
struct MethodChoice {
  std::string name;
  std::string settings;
  std::function<std::unique_ptr<BenchMethod>()> make;
};

/// Ours.
MethodChoice lodestar_method();

/// The settings of a peer to try, the best of which is kept; empty when the program was built without that
/// library. Peers are "apriltag" and "aruco".
std::vector<MethodChoice> peer_methods(const std::string& peer);

}  // namespace lodestar
