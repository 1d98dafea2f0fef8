#pragma once

#include <optional>
#include <string>

#include "maps/frame.hpp"

namespace lodestar {

/// Source of frames: a device, image files or the simulated world.
class Camera {
 public:
  Camera() = default;
  Camera(const Camera&) = delete;
  Camera& operator=(const Camera&) = delete;
  virtual ~Camera() = default;

  /// The oldest frame not yet polled; empty when none has arrived. Never blocks.
  virtual std::optional<Frame> poll() = 0;

  /// What the device and its driver claim about the frames, in words; empty for what has no driver.
  [[nodiscard]] virtual std::string description() const { return {}; }
};

}  // namespace lodestar
