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

/// A marker that a method says it saw.
struct ReadMarker {
  int id = 0;
  Vec2 center_px = Vec2::Zero();
  std::optional<double> probability;  ///< that the ID is right, as stated by the method
};

/// What a method makes of one frame.
struct MethodResult {
  std::vector<ReadMarker> markers;
  std::optional<Eigen::Isometry3d> upright;  ///< map_from_camera, the tilt being known
  std::optional<Eigen::Isometry3d> free;     ///< map_from_camera, nothing being known
  double microseconds = 0.0;                 ///< from the frame to the first pose, one thread
};

/// One way to localize by markers, as `bench localize` runs it. Not for two threads at once.
class BenchMethod {
 public:
  virtual ~BenchMethod() = default;

  /// Puts the method's own markers on the ceiling, at the places of the registry's, and tells it which to
  /// expect.
  virtual void hang(const MarkerRegistry& registry, ImageFormer& former) = 0;

  /// The ID that hangs at the place of the registry's i-th marker.
  [[nodiscard]] virtual int id_at(const MarkerRegistry& registry, std::size_t i) const = 0;

  /// Is it run several times, for the least time? One that takes milliseconds gains nothing by it.
  [[nodiscard]] virtual bool is_quick() const { return false; }
  virtual std::vector<ReadMarker> read(const cv::Mat& gray) = 0;

  /// Reads and measures. `tilt` is as in PosePrior.
  virtual MethodResult run(const cv::Mat& gray, const MarkerRegistry& registry, const CameraModel& camera,
                           const Eigen::Matrix3d& tilt) = 0;
};

/// How to get a method, and with which settings.
struct MethodChoice {
  std::string name;
  std::string settings;
  std::function<std::unique_ptr<BenchMethod>()> make;
};

/// Ours.
MethodChoice lodestar_method();

/// The settings of a peer that are tried, of which the best is then kept; empty when the program was built
/// without that library. Peers are "apriltag" and "aruco".
std::vector<MethodChoice> peer_methods(const std::string& peer);

}  // namespace lodestar
