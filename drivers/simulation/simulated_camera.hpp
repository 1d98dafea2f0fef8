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

/// A camera on the simulated robot. The world tells it at every step where the base truly is; frame number k
/// opens at k periods after time 0, is stamped with the middle of its exposure and arrives `latency` later,
/// unless it is lost. The body wobbles a little about the floor point. Equal seeds and equal drives give
/// equal bytes.
class SimulatedCamera : public Camera {
 public:
  /// Throws InputError unless 0 <= exposure < period, latency >= exposure / 2 and the probability is in
  /// [0, 1].
  SimulatedCamera(const MarkerRegistry& registry, const CameraModel& camera,
                  const Eigen::Isometry3d& base_from_camera, const SimulatedCameraOptions& options,
                  std::uint64_t seed);

  /// The base's true pose at `now`. Stamps ascend; between two of them the base is taken to move evenly.
  void observe(Stamp now, const Pose2& true_map_from_base);

  /// From the next frame on these markers hang on the ceiling, and such lamps beside its own.
  void rehang(const MarkerRegistry& registry, std::vector<CeilingDisc> more_lamps);

  /// A frame is formed when it is asked for, so one that nobody polls costs nothing.
  std::optional<Frame> poll() override;

  /// Drops the oldest of the frames that were not polled until so many are left, as a device does that has no
  /// more buffers.
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
  };

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
  std::optional<Exposure> open_;       ///< begun, not yet closed
  std::uint64_t next_number_ = 0;      ///< of the frame that opens next
  std::deque<Exposure> on_their_way_;  ///< closed, not yet polled
};

}  // namespace lodestar
