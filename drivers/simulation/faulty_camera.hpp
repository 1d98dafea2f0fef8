#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "drivers/camera/camera.hpp"
#include "drivers/simulation/fault.hpp"

namespace lodestar {

/// A camera with faults of its driver, lens and sensor. Without a fault it changes nothing.
class FaultyCamera final : public Camera {
 public:
  FaultyCamera(Camera& camera, std::uint64_t seed) : camera_(camera), seed_(seed) {}

  /// Sets the active faults; those that do not concern the camera are ignored.
  void suffer(const std::vector<Fault>& active) { active_ = active; }
  void advance(Stamp now) { now_ = now; }

  std::optional<Frame> poll() override;

 private:
  struct Waiting {
    Stamp arrival;
    Frame frame;
  };

  /// Empty when the frame is dropped.
  [[nodiscard]] std::optional<Waiting> spoiled(Frame frame) const;

  Camera& camera_;
  std::uint64_t seed_;
  std::vector<Fault> active_;
  Stamp now_;
  cv::Mat last_;                 ///< the image delivered last
  std::deque<Waiting> waiting_;  ///< in order of capture
};

}  // namespace lodestar
