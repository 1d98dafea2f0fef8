#pragma once

#include <optional>
#include <string>

#include "maps/depth_image.hpp"

namespace lodestar {

/// Source of depth images: a device or the simulated world.
class DepthCamera {
 public:
  DepthCamera() = default;
  DepthCamera(const DepthCamera&) = delete;
  DepthCamera& operator=(const DepthCamera&) = delete;
  virtual ~DepthCamera() = default;

  /// The oldest image not yet polled; empty when none has arrived. Never blocks.
  virtual std::optional<DepthImage> poll() = 0;

  /// What the device and its driver claim about the images, in words; empty for what has no driver.
  [[nodiscard]] virtual std::string description() const { return {}; }
};

}  // namespace lodestar
