#pragma once

#include <optional>

#include "maps/frame.hpp"

namespace lodestar {

/// Where frames come from: a device, image files or the simulated world.
class Camera {
 public:
  Camera() = default;
  Camera(const Camera&) = delete;
  Camera& operator=(const Camera&) = delete;
  virtual ~Camera() = default;

  /// The next frame that has arrived, oldest first; nothing when none has. Never blocks.
  virtual std::optional<Frame> poll() = 0;
};

}  // namespace lodestar
