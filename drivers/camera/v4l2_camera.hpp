#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/camera/device_camera.hpp"
#include "drivers/camera/v4l2_pixels.hpp"
#include "drivers/camera/video_device.hpp"

struct v4l2_buffer;

namespace lodestar {

/// The moment that a driver stamps a frame with.
enum class StampedAt {
  exposure_start,
  arrival  ///< the readout's or transfer's start or end, in any case after the exposure
};

struct V4l2CameraOptions {
  int width_px = 0;   ///< 0: whatever the camera is set to
  int height_px = 0;  ///< the same
  /// Buffers in which the device keeps frames until they are polled; when all are full it drops new frames.
  int buffers = 4;
  bool depth = false;  ///< of a depth camera: frames are depths in millimetres (CV_16UC1)
  // Set at every opening; empty: as the camera is set.
  std::optional<Duration> exposure;
  std::optional<int> gain;  ///< in the driver's unit
  std::optional<double> rate_hz;
  /// From the end of exposure to the stamp of arrival: readout and transfer.
  Duration latency{};
  /// What the stamps are; empty: what the driver flags, with two exceptions. uvcvideo flags the start of
  /// exposure whatever its camera does: it stamps the first packet, or the camera's own clock at the start of
  /// the readout. And a stamp that lies less than the exposure before the frame's arrival is not its start.
  std::optional<StampedAt> stamped_at;
  /// Between two readings of an exposure that is not set here: it may be automatic.
  Duration exposure_read_period = std::chrono::seconds(1);
};

/// A Linux V4L2 camera (USB, CSI) that streams into memory-mapped buffers. Stamps are the driver's
/// (CLOCK_MONOTONIC), moved to mid-exposure where the camera reports its exposure time; with a driver that
/// has no such stamps, the time of arrival.
class V4l2Camera final : public DeviceCamera {
 public:
  /// Starts streaming. Throws InputError, naming `name`, when the device is not a streaming camera, has no
  /// supported pixel format, does not deliver the requested size, or does not take a setting.
  V4l2Camera(std::unique_ptr<VideoDevice> device, const std::string& name, const V4l2CameraOptions& options);
  ~V4l2Camera() override;

  /// Frames that the driver marks as damaged are skipped.
  std::optional<Frame> poll() override;

  [[nodiscard]] std::string description() const override;

  /// Waits for a frame, a signal, or at most this long.
  void wait(Duration at_most) { device_->wait(at_most); }

  [[nodiscard]] bool lost() const override { return lost_; }

  [[nodiscard]] const V4l2Layout& layout() const { return layout_; }

 private:
  void require_streaming();
  void choose_layout();
  void apply_settings();
  void start();
  void read_exposure();
  [[nodiscard]] Stamp middle_of_exposure(const v4l2_buffer& buffer);
  [[nodiscard]] StampedAt stamped_at(const v4l2_buffer& buffer, Stamp stamp);
  [[noreturn]] void refuse(const std::string& found, const std::string& wanted) const;

  std::unique_ptr<VideoDevice> device_;
  std::string name_;
  V4l2CameraOptions options_;
  V4l2Layout layout_;
  std::string driver_;
  Duration exposure_{};  ///< zero where the camera does not report it
  std::optional<Stamp> exposure_read_;
  std::optional<StampedAt> flagged_;  ///< by the newest frame with a stamp
  std::optional<StampedAt> taken_as_;
  bool start_is_impossible_ = false;
  std::vector<std::span<const std::uint8_t>> buffers_;
  bool lost_ = false;
};

}  // namespace lodestar
