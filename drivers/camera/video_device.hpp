#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "maps/stamp.hpp"

namespace lodestar {

/// A V4L2 device node: the few system calls of it that a camera needs. Tests put a device of their own here.
class VideoDevice {
 public:
  VideoDevice() = default;
  VideoDevice(const VideoDevice&) = delete;
  VideoDevice& operator=(const VideoDevice&) = delete;
  virtual ~VideoDevice() = default;

  /// ioctl, made again when a signal interrupts it. 0, or the error number (EAGAIN: nothing there yet).
  [[nodiscard]] virtual int control(unsigned long request, void* argument) = 0;

  /// The device's memory of one buffer, for as long as the device is open; empty when it cannot be mapped.
  [[nodiscard]] virtual std::span<const std::uint8_t> map(std::size_t length, std::int64_t offset) = 0;

  /// Waits for a buffer to be filled, until a signal arrives, or for so long.
  virtual void wait(Duration at_most) = 0;

  /// The clock that V4L2 stamps are of, CLOCK_MONOTONIC.
  [[nodiscard]] virtual Stamp now() const = 0;
};

/// Opens `/dev/video0`. Throws InputError when that cannot be opened for reading and writing.
std::unique_ptr<VideoDevice> open_video_device(const std::filesystem::path& file);

}  // namespace lodestar
