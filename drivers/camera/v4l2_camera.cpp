#include "drivers/camera/v4l2_camera.hpp"

#include <algorithm>
#include <cerrno>
#include <fmt/format.h>
#include <linux/videodev2.h>

#include "drivers/camera/v4l2_controls.hpp"
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

std::string in_words(StampedAt moment) {
  return moment == StampedAt::exposure_start ? "start of exposure" : "arrival";
}

}  // namespace

V4l2Camera::V4l2Camera(std::unique_ptr<VideoDevice> device, const std::string& name,
                       const V4l2CameraOptions& options)
    : device_(std::move(device)), name_(name), options_(options) {
  require_streaming();
  choose_layout();
  apply_settings();
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
  driver_ = reinterpret_cast<const char*>(capability.driver);
  const std::uint32_t can = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0U ? capability.device_caps
                                                                                   : capability.capabilities;
  constexpr std::uint32_t needed = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  if ((can & needed) != needed) refuse("a video device that does not capture", wanted);
}

void V4l2Camera::choose_layout() {
  const std::vector<std::uint32_t> offered = formats_of(*device_);
  const auto readable = options_.depth ? readable_v4l2_depth_formats() : readable_v4l2_formats();
  const auto best = std::ranges::find_first_of(readable, offered);
  if (best == readable.end()) {
    std::string names;
    for (const std::uint32_t format : offered) names += fourcc_name(format) + " ";
    refuse(fmt::format("pixel formats {}", names.empty() ? "none " : names) + "only",
           options_.depth ? "depths of 16 bits (Z16)" : "gray, YUV or JPEG (GREY, YUYV, MJPG ...)");
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

void V4l2Camera::apply_settings() {
  if (options_.rate_hz) set_frame_rate(*device_, name_, *options_.rate_hz);
  if (options_.exposure) set_exposure(*device_, name_, *options_.exposure);
  if (options_.gain) set_gain(*device_, name_, *options_.gain);
  read_exposure();
}

void V4l2Camera::read_exposure() {
  const Stamp now = device_->now();
  const bool is_known =
      exposure_read_ && (options_.exposure || now - *exposure_read_ < options_.exposure_read_period);
  if (is_known) return;
  exposure_read_ = now;
  exposure_ = exposure_of(*device_).value_or(options_.exposure.value_or(Duration{}));
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

Stamp V4l2Camera::middle_of_exposure(const v4l2_buffer& buffer) {
  Stamp stamp = device_->now();
  StampedAt moment = StampedAt::arrival;
  if ((buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) {
    stamp = Stamp(std::chrono::seconds(buffer.timestamp.tv_sec) +
                  std::chrono::microseconds(buffer.timestamp.tv_usec));
    moment = stamped_at(buffer, stamp);
  }
  taken_as_ = moment;
  return moment == StampedAt::exposure_start ? stamp + exposure_ / 2
                                             : stamp - options_.latency - exposure_ / 2;
}

StampedAt V4l2Camera::stamped_at(const v4l2_buffer& buffer, Stamp stamp) {
  const bool flags_start = (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  flagged_ = flags_start ? StampedAt::exposure_start : StampedAt::arrival;
  if (options_.stamped_at) return *options_.stamped_at;
  if (stamp + exposure_ > device_->now()) start_is_impossible_ = true;
  const bool flags_in_vain = driver_ == "uvcvideo" || start_is_impossible_;
  return flags_in_vain ? StampedAt::arrival : *flagged_;
}

std::string V4l2Camera::description() const {
  std::string words = fmt::format("{}: {} x {} {}", driver_.empty() ? name_ : driver_, layout_.width_px,
                                  layout_.height_px, fourcc_name(layout_.fourcc));
  if (const auto rate_hz = frame_rate_of(*device_))
    words += fmt::format(", {:.4g} frames a second", *rate_hz);
  if (exposure_ > Duration{}) {
    words += fmt::format(", exposure {:.1f} ms ({})", 1e3 * seconds(exposure_),
                         has_automatic_exposure(*device_) ? "automatic" : "fixed");
  } else {
    words += ", exposure not reported";
  }
  if (!taken_as_) return words;
  words += flagged_ ? ", stamps flagged as " + in_words(*flagged_) : ", no stamps";
  if (taken_as_ != flagged_) words += ", taken as " + in_words(*taken_as_);
  return words;
}

std::optional<Frame> V4l2Camera::poll() {
  while (!lost_) {
    v4l2_buffer buffer = a_buffer();
    const int error = device_->control(VIDIOC_DQBUF, &buffer);
    if (error == EAGAIN) return std::nullopt;
    if (error != 0 || buffer.index >= buffers_.size()) break;

    const auto memory = buffers_[buffer.index];
    const auto filled = memory.first(std::min<std::size_t>(buffer.bytesused, memory.size()));
    read_exposure();
    const bool damaged = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0U;
    Frame frame{.stamp = middle_of_exposure(buffer), .gray = damaged ? cv::Mat() : gray_of(layout_, filled)};
    lost_ = device_->control(VIDIOC_QBUF, &buffer) != 0;
    if (!frame.gray.empty()) return frame;
  }
  lost_ = true;
  return std::nullopt;
}

}  // namespace lodestar
