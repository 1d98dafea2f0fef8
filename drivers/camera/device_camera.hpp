#pragma once

#include "drivers/camera/camera.hpp"

namespace lodestar {

/// A camera on a cable.
class DeviceCamera : public Camera {
 public:
  /// True when the device has disappeared; poll() then never returns a frame again.
  [[nodiscard]] virtual bool lost() const = 0;
};

}  // namespace lodestar
