#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "maps/stamp.hpp"

namespace lodestar {

/// A V4L2 device node: the few system calls that a camera needs. Tests substitute their own device.
class VideoDevice {
 public:
  VideoDevice() = default;
  VideoDevice(const VideoDevice&) = delete;
  VideoDevice& operator=(const VideoDevice&) = delete;
  virtual ~VideoDevice() = default;

  /// ioctl, repeated when a signal interrupts it. Returns 0 or the error number (EAGAIN: nothing available
  /// yet).
  [[nodiscard]] virtual int control(unsigned long request, void* argument) = 0;

  /// The mapped memory of one buffer, valid while the device is open; empty when it cannot be mapped.
  [[nodiscard]] virtual std::span<const std::uint8_t> map(std::size_t length, std::int64_t offset) = 0;

  /// Waits for a filled buffer, a signal, or at most this long.
  virtual void wait(Duration at_most) = 0;

  /// The clock of V4L2 stamps, CLOCK_MONOTONIC.
  [[nodiscard]] virtual Stamp now() const = 0;
};

/// Opens a device node such as `/dev/video0`. Throws InputError when it cannot be opened for reading and
/// writing.
std::unique_ptr<VideoDevice> open_video_device(const std::filesystem::path& file);

}  // namespace lodestar
