#include "drivers/camera/v4l2_camera.hpp"

#include <algorithm>
#include <cerrno>
#include <fmt/format.h>
#include <linux/videodev2.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

v4l2_buffer a_buffer(std::uint32_t index = 0) {
  v4l2_buffer buffer{};
  buffer.index = index;
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  return buffer;
}

std::vector<std::uint32_t> formats_of(VideoDevice& device) {
  std::vector<std::uint32_t> formats;
  v4l2_fmtdesc description{};
  description.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  while (device.control(VIDIOC_ENUM_FMT, &description) == 0) {
    formats.push_back(description.pixelformat);
    ++description.index;
  }
  return formats;
}

/// V4L2's default quantization of a YUV format when the driver does not state it: limited range, except for
/// JPEG's colour space.
bool has_limited_luma(const v4l2_pix_format& pixels) {
  if (pixels.quantization != V4L2_QUANTIZATION_DEFAULT)
    return pixels.quantization == V4L2_QUANTIZATION_LIM_RANGE;
  return pixels.colorspace != V4L2_COLORSPACE_JPEG;
}

/// The exposure time if the camera reports it, otherwise zero.
Duration exposure_of(VideoDevice& device) {
  v4l2_control exposure{.id = V4L2_CID_EXPOSURE_ABSOLUTE, .value = 0};
  if (device.control(VIDIOC_G_CTRL, &exposure) != 0) return {};
  constexpr std::chrono::microseconds unit(100);
  return std::max(exposure.value, 0) * unit;
}

}  // namespace

V4l2Camera::V4l2Camera(std::unique_ptr<VideoDevice> device, const std::string& name,
                       const V4l2CameraOptions& options)
    : device_(std::move(device)), name_(name), options_(options) {
  require_streaming();
  choose_layout();
  exposure_ = exposure_of(*device_);
  start();
}

V4l2Camera::~V4l2Camera() {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  (void)device_->control(VIDIOC_STREAMOFF, &type);
}

void V4l2Camera::refuse(const std::string& found, const std::string& wanted) const {
  throw InputError(name_, 0, found, wanted);
}

void V4l2Camera::require_streaming() {
  constexpr const char* wanted = "a V4L2 camera that streams";
  v4l2_capability capability{};
  if (device_->control(VIDIOC_QUERYCAP, &capability) != 0) refuse("no video device", wanted);
  const std::uint32_t can = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0U ? capability.device_caps
                                                                                   : capability.capabilities;
  constexpr std::uint32_t needed = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  if ((can & needed) != needed) refuse("a video device that does not capture", wanted);
}

void V4l2Camera::choose_layout() {
  const std::vector<std::uint32_t> offered = formats_of(*device_);
  const auto readable = readable_v4l2_formats();
  const auto best = std::ranges::find_first_of(readable, offered);
  if (best == readable.end()) {
    std::string names;
    for (const std::uint32_t format : offered) names += fourcc_name(format) + " ";
    refuse(fmt::format("pixel formats {}", names.empty() ? "none " : names) + "only",
           "gray, YUV or JPEG (GREY, YUYV, MJPG ...)");
  }

  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  (void)device_->control(VIDIOC_G_FMT, &format);
  v4l2_pix_format& pixels = format.fmt.pix;
  pixels.pixelformat = *best;
  pixels.field = V4L2_FIELD_NONE;
  pixels.bytesperline = 0;  // the driver's choice
  if (options_.width_px > 0) pixels.width = static_cast<std::uint32_t>(options_.width_px);
  if (options_.height_px > 0) pixels.height = static_cast<std::uint32_t>(options_.height_px);
  const int error = device_->control(VIDIOC_S_FMT, &format);
  if (error == EBUSY) refuse("a camera that is in use", "one that is free");
  if (error != 0 || pixels.pixelformat != *best) refuse("no way to set the pixel format", fourcc_name(*best));
  layout_ = {.fourcc = pixels.pixelformat,
             .width_px = static_cast<int>(pixels.width),
             .height_px = static_cast<int>(pixels.height),
             .bytes_per_line = static_cast<int>(pixels.bytesperline),
             .limited_luma = has_limited_luma(pixels)};
  const bool as_wanted = (options_.width_px == 0 || options_.width_px == layout_.width_px) &&
                         (options_.height_px == 0 || options_.height_px == layout_.height_px);
  if (!as_wanted) {
    refuse(fmt::format("{} x {} pixels", layout_.width_px, layout_.height_px),
           fmt::format("{} x {}", options_.width_px, options_.height_px));
  }
}

void V4l2Camera::start() {
  constexpr const char* wanted = "buffers to stream into";
  v4l2_requestbuffers request{};
  request.count = static_cast<std::uint32_t>(options_.buffers);
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  const int error = device_->control(VIDIOC_REQBUFS, &request);
  if (error == EBUSY) refuse("a camera that is in use", "one that is free");
  if (error != 0 || request.count == 0) refuse("a device without memory to map", wanted);
  for (std::uint32_t i = 0; i < request.count; ++i) {
    v4l2_buffer buffer = a_buffer(i);
    if (device_->control(VIDIOC_QUERYBUF, &buffer) != 0) refuse("a device without memory to map", wanted);
    buffers_.push_back(device_->map(buffer.length, buffer.m.offset));
    if (buffers_.back().empty() || device_->control(VIDIOC_QBUF, &buffer) != 0)
      refuse("memory that cannot be mapped", wanted);
  }
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (device_->control(VIDIOC_STREAMON, &type) != 0) refuse("a camera that does not start", "a stream");
}

Stamp V4l2Camera::middle_of_exposure(const v4l2_buffer& buffer) const {
  if ((buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC)
    return device_->now() - exposure_ / 2;
  const Stamp stamp(std::chrono::seconds(buffer.timestamp.tv_sec) +
                    std::chrono::microseconds(buffer.timestamp.tv_usec));
  const bool at_start = (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  return at_start ? stamp + exposure_ / 2 : stamp - options_.readout - exposure_ / 2;
}

std::optional<Frame> V4l2Camera::poll() {
  while (!lost_) {
    v4l2_buffer buffer = a_buffer();
    const int error = device_->control(VIDIOC_DQBUF, &buffer);
    if (error == EAGAIN) return std::nullopt;
    if (error != 0 || buffer.index >= buffers_.size()) break;

    const auto memory = buffers_[buffer.index];
    const auto filled = memory.first(std::min<std::size_t>(buffer.bytesused, memory.size()));
    const bool damaged = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0U;
    Frame frame{.stamp = middle_of_exposure(buffer), .gray = damaged ? cv::Mat() : gray_of(layout_, filled)};
    lost_ = device_->control(VIDIOC_QBUF, &buffer) != 0;
    if (!frame.gray.empty()) return frame;
  }
  lost_ = true;
  return std::nullopt;
}

}  // namespace lodestar
