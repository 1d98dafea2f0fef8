#pragma once

#include <cstdint>
#include <deque>

#include "drivers/camera/camera.hpp"
#include "drivers/simulation/image_former.hpp"
#include "drivers/simulation/simulated_camera_options.hpp"
#include "drivers/simulation/tilt_wobble.hpp"
#include "maps/camera_model.hpp"
#include "maps/geometry.hpp"
#include "maps/marker_registry.hpp"

namespace lodestar {

/// A camera on the simulated robot. The world passes it the base's true pose at every step; the exposure of
/// frame k begins k periods after time 0, the frame is stamped with mid-exposure and arrives `latency` later,
/// unless it is lost. The body tilts slightly about its point on the floor. Equal seeds and equal drives give
/// equal bytes.
class SimulatedCamera : public Camera {
 public:
  /// Throws InputError unless 0 <= exposure < period, latency >= exposure / 2 and the probability is in
  /// [0, 1].
  SimulatedCamera(const MarkerRegistry& registry, const CameraModel& camera,
                  const Eigen::Isometry3d& base_from_camera, const SimulatedCameraOptions& options,
                  std::uint64_t seed);

  /// The base's true pose at `now`. Stamps ascend; motion is interpolated linearly between them.
  void observe(Stamp now, const Pose2& true_map_from_base);

  /// Replaces the markers, and the lamps in addition to the ceiling's own, for frames exposed from now on.
  void rehang(const MarkerRegistry& registry, std::vector<CeilingDisc> more_lamps);

  /// A frame is rendered when it is polled; one that is not polled costs nothing.
  std::optional<Frame> poll() override;

  /// Drops the oldest unpolled frames until this many are left, like a device that runs out of buffers.
  void keep_newest(std::size_t frames);

 private:
  struct Observation {
    Stamp stamp;
    Pose2 map_from_base;
  };
  struct Exposure {
    std::uint64_t number = 0;
    Stamp opening;
    Eigen::Isometry3d map_from_camera_at_opening;
    Eigen::Isometry3d map_from_camera_at_closing;
    cv::Mat gray;  ///< formed when it arrives, or when the ceiling changes before
  };

  void form(Exposure& exposure);
  [[nodiscard]] Stamp opening_of(std::uint64_t number) const;
  [[nodiscard]] Stamp arrival_of(const Exposure& exposure) const;
  [[nodiscard]] bool is_lost(std::uint64_t number) const;
  [[nodiscard]] Eigen::Isometry3d map_from_camera_at(Stamp stamp, const Observation& before,
                                                     const Observation& after) const;

  Eigen::Isometry3d base_from_camera_;
  SimulatedCameraOptions options_;
  std::uint64_t seed_;
  TiltWobble wobble_;
  ImageFormer image_former_;
  std::optional<Observation> last_;
  std::optional<Exposure> open_;       ///< in progress
  std::uint64_t next_number_ = 0;      ///< of the next frame to be exposed
  std::deque<Exposure> on_their_way_;  ///< exposed, not yet polled
};

}  // namespace lodestar
