#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "drivers/camera/camera.hpp"
#include "drivers/simulation/fault.hpp"

namespace lodestar {

/// A camera with the faults of its driver, its lens and its sensor. Without any it changes nothing.
class FaultyCamera final : public Camera {
 public:
  FaultyCamera(Camera& camera, std::uint64_t seed) : camera_(camera), seed_(seed) {}

  /// These faults are on from now on; those of other parts are ignored.
  void suffer(const std::vector<Fault>& active) { active_ = active; }
  void advance(Stamp now) { now_ = now; }

  std::optional<Frame> poll() override;

 private:
  struct Waiting {
    Stamp arrival;
    Frame frame;
  };

  /// Nothing when the frame is dropped.
  [[nodiscard]] std::optional<Waiting> spoiled(Frame frame) const;

  Camera& camera_;
  std::uint64_t seed_;
  std::vector<Fault> active_;
  Stamp now_;
  cv::Mat last_;                 ///< the picture delivered last
  std::deque<Waiting> waiting_;  ///< in the order of capture
};

}  // namespace lodestar
