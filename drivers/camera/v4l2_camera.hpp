#pragma once

#include <memory>
#include <span>
#include <vector>

#include "drivers/camera/camera.hpp"
#include "drivers/camera/v4l2_pixels.hpp"
#include "drivers/camera/video_device.hpp"

struct v4l2_buffer;

namespace lodestar {

struct V4l2CameraOptions {
  int width_px = 0;   ///< 0: whatever the camera is set to
  int height_px = 0;  ///< the same
  int buffers =
      4;  ///< in which the device keeps frames until they are polled; when all are full it drops new ones
  Duration
      readout{};  ///< from the end of the exposure to the end of the transfer, where the driver stamps that
};

/// A camera of Linux's V4L2 (USB, CSI), streaming from its own memory. Stamps are the driver's, of
/// CLOCK_MONOTONIC, taken to the middle of the exposure as far as the camera tells how long that is; a driver
/// without such stamps gets the time of arrival.
class V4l2Camera final : public Camera {
 public:
  /// Starts streaming. Throws InputError, naming `name`, when the device is no camera that streams, has none
  /// of the readable pixel formats, or not the size that is wanted.
  V4l2Camera(std::unique_ptr<VideoDevice> device, const std::string& name, const V4l2CameraOptions& options);
  ~V4l2Camera() override;

  /// Frames that the driver marks as damaged are left out.
  std::optional<Frame> poll() override;

  /// Waits for a frame, until a signal arrives, or for so long.
  void wait(Duration at_most) { device_->wait(at_most); }

  /// Is the device gone? poll() then gives nothing for ever.
  [[nodiscard]] bool lost() const { return lost_; }

  [[nodiscard]] const V4l2Layout& layout() const { return layout_; }

 private:
  void require_streaming();
  void choose_layout();
  void start();
  [[nodiscard]] Stamp middle_of_exposure(const v4l2_buffer& buffer) const;
  [[noreturn]] void refuse(const std::string& found, const std::string& wanted) const;

  std::unique_ptr<VideoDevice> device_;
  std::string name_;
  V4l2CameraOptions options_;
  V4l2Layout layout_;
  Duration exposure_{};
  std::vector<std::span<const std::uint8_t>> buffers_;
  bool lost_ = false;
};

}  // namespace lodestar
