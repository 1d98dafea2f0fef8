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
  /// Buffers in which the device keeps frames until they are polled; when all are full it drops new frames.
  int buffers = 4;
  /// From the end of exposure to the end of transfer, for drivers that stamp the latter.
  Duration readout{};
};

/// A Linux V4L2 camera (USB, CSI) that streams into memory-mapped buffers. Stamps are the driver's
/// (CLOCK_MONOTONIC), moved to mid-exposure where the camera reports its exposure time; with a driver that
/// has no such stamps, the time of arrival.
class V4l2Camera final : public Camera {
 public:
  /// Starts streaming. Throws InputError, naming `name`, when the device is not a streaming camera, has no
  /// supported pixel format, or does not deliver the requested size.
  V4l2Camera(std::unique_ptr<VideoDevice> device, const std::string& name, const V4l2CameraOptions& options);
  ~V4l2Camera() override;

  /// Frames that the driver marks as damaged are skipped.
  std::optional<Frame> poll() override;

  /// Waits for a frame, a signal, or at most this long.
  void wait(Duration at_most) { device_->wait(at_most); }

  /// True when the device has disappeared; poll() then never returns a frame again.
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
