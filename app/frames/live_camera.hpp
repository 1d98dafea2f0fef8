#pragma once

#include <filesystem>

#include "app/common/interruption.hpp"
#include "app/frames/frame_source.hpp"
#include "drivers/camera/v4l2_camera.hpp"
#include "maps/camera_model.hpp"

namespace lodestar {

/// The frames of a V4L2 device as they arrive, until Ctrl-C. Stamp: the driver's, since boot.
class LiveCamera final : public FrameSource {
 public:
  /// Throws InputError when the device cannot be used, or not at the calibrated camera's resolution.
  LiveCamera(const std::filesystem::path& device, const std::optional<CameraModel>& camera);

  /// Waits for a frame. Nothing after Ctrl-C. Throws InputError when the device is gone, or silent for
  /// seconds.
  std::optional<SourceFrame> next() override;

 private:
  std::filesystem::path file_;
  V4l2Camera device_;
  Interruption interruption_;
  int frame_ = 0;
};

}  // namespace lodestar
