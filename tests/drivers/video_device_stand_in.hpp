#pragma once

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <iterator>
#include <linux/videodev2.h>
#include <string>
#include <vector>

#include "drivers/camera/video_device.hpp"

namespace lodestar {

/// What the simulated device offers a camera driver, and what the driver did with it.
struct VideoScript {
  std::uint32_t capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  std::vector<std::uint32_t> formats{V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_GREY};
  std::uint32_t width_px = 8;  ///< the only size
  std::uint32_t height_px = 4;
  std::uint32_t padding = 0;  ///< bytes after each line
  std::string driver;
  int exposure_100us = -1;       ///< -1: no such control
  int least_exposure_100us = 1;  ///< what is set below becomes this
  int exposure_mode = V4L2_EXPOSURE_MANUAL;
  int gain = -1;            ///< -1: no such control
  v4l2_fract frame_time{};  ///< zero: cannot be set
  v4l2_fract least_frame_time{.numerator = 1, .denominator = 100};
  Stamp now{std::chrono::seconds(50)};
  bool in_use = false;
  bool unplugged = false;

  struct Capture {
    std::vector<std::uint8_t> bytes;
    std::uint32_t flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
    timeval stamp{};
  };
  std::deque<Capture> captures;  ///< each fills a buffer once the driver has queued one

  std::uint32_t chosen_format = 0;
  bool streaming = false;
  bool closed = false;
};

/// A V4L2 device in memory.
class VideoDeviceStandIn final : public VideoDevice {
 public:
  explicit VideoDeviceStandIn(VideoScript& script) : script_(script) {}
  ~VideoDeviceStandIn() override { script_.closed = true; }

  int control(unsigned long request, void* argument) override {
    if (script_.unplugged) return ENODEV;
    switch (request) {
      case VIDIOC_QUERYCAP: {
        auto* capability = static_cast<v4l2_capability*>(argument);
        capability->capabilities = script_.capabilities;
        std::ranges::copy(script_.driver, std::begin(capability->driver));
        return 0;
      }
      case VIDIOC_ENUM_FMT: {
        auto* description = static_cast<v4l2_fmtdesc*>(argument);
        if (description->index >= script_.formats.size()) return EINVAL;
        description->pixelformat = script_.formats[description->index];
        return 0;
      }
      case VIDIOC_G_FMT:
        return 0;
      case VIDIOC_S_FMT:
        return set_format(static_cast<v4l2_format*>(argument)->fmt.pix);
      case VIDIOC_G_CTRL:
        return get(*static_cast<v4l2_control*>(argument));
      case VIDIOC_S_CTRL:
        return set(*static_cast<const v4l2_control*>(argument));
      case VIDIOC_G_PARM:
        static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe = script_.frame_time;
        return script_.frame_time.denominator == 0 ? ENOTTY : 0;
      case VIDIOC_S_PARM:
        return set_frame_time(static_cast<const v4l2_streamparm*>(argument)->parm.capture.timeperframe);
      case VIDIOC_REQBUFS:
        buffers_.assign(static_cast<v4l2_requestbuffers*>(argument)->count, std::vector<std::uint8_t>(4096));
        return 0;
      case VIDIOC_QUERYBUF: {
        auto* buffer = static_cast<v4l2_buffer*>(argument);
        buffer->length = 4096;
        buffer->m.offset = buffer->index;
        return 0;
      }
      case VIDIOC_QBUF:
        queued_.push_back(static_cast<v4l2_buffer*>(argument)->index);
        return 0;
      case VIDIOC_DQBUF:
        return give(*static_cast<v4l2_buffer*>(argument));
      case VIDIOC_STREAMON:
        script_.streaming = true;
        return 0;
      case VIDIOC_STREAMOFF:
        script_.streaming = false;
        return 0;
      default:
        return ENOTTY;
    }
  }

  std::span<const std::uint8_t> map(std::size_t length, std::int64_t offset) override {
    return {buffers_.at(static_cast<std::size_t>(offset)).data(), length};
  }

  void wait(Duration /*at_most*/) override {}

  [[nodiscard]] Stamp now() const override { return script_.now; }

  [[nodiscard]] std::size_t queued() const { return queued_.size(); }

 private:
  int get(v4l2_control& control) const {
    switch (control.id) {
      case V4L2_CID_EXPOSURE_ABSOLUTE:
        control.value = script_.exposure_100us;
        break;
      case V4L2_CID_EXPOSURE_AUTO:
        control.value = script_.exposure_100us < 0 ? -1 : script_.exposure_mode;
        break;
      case V4L2_CID_GAIN:
        control.value = script_.gain;
        break;
      default:
        return EINVAL;
    }
    return control.value < 0 ? EINVAL : 0;
  }

  int set(const v4l2_control& control) {
    v4l2_control before{.id = control.id, .value = 0};
    if (get(before) != 0) return EINVAL;
    if (control.id == V4L2_CID_EXPOSURE_AUTO) script_.exposure_mode = control.value;
    if (control.id == V4L2_CID_GAIN) script_.gain = control.value;
    if (control.id == V4L2_CID_EXPOSURE_ABSOLUTE) {
      if (script_.exposure_mode != V4L2_EXPOSURE_MANUAL) return EBUSY;
      script_.exposure_100us = std::max(control.value, script_.least_exposure_100us);
    }
    return 0;
  }

  int set_frame_time(const v4l2_fract& time) {
    if (script_.frame_time.denominator == 0) return ENOTTY;
    const auto seconds_of = [](const v4l2_fract& some) { return 1.0 * some.numerator / some.denominator; };
    const bool is_too_short = seconds_of(time) < seconds_of(script_.least_frame_time);
    script_.frame_time = is_too_short ? script_.least_frame_time : time;
    return 0;
  }

  int set_format(v4l2_pix_format& pixels) {
    if (script_.in_use) return EBUSY;
    pixels.width = script_.width_px;
    pixels.height = script_.height_px;
    pixels.bytesperline =
        script_.width_px * (pixels.pixelformat == V4L2_PIX_FMT_GREY ? 1U : 2U) + script_.padding;
    script_.chosen_format = pixels.pixelformat;
    return 0;
  }

  int give(v4l2_buffer& buffer) {
    if (script_.captures.empty() || queued_.empty()) return EAGAIN;
    const VideoScript::Capture capture = script_.captures.front();
    script_.captures.pop_front();
    buffer.index = queued_.front();
    queued_.pop_front();
    std::ranges::copy(capture.bytes, buffers_[buffer.index].begin());
    buffer.bytesused = static_cast<std::uint32_t>(capture.bytes.size());
    buffer.flags = capture.flags;
    buffer.timestamp = capture.stamp;
    return 0;
  }

  VideoScript& script_;
  std::vector<std::vector<std::uint8_t>> buffers_;
  std::deque<std::uint32_t> queued_;
};

}  // namespace lodestar
