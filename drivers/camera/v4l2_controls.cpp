#include "drivers/camera/v4l2_controls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <linux/videodev2.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

constexpr std::chrono::microseconds exposure_unit(100);

std::optional<int> value_of(VideoDevice& device, std::uint32_t id) {
  v4l2_control control{.id = id, .value = 0};
  if (device.control(VIDIOC_G_CTRL, &control) != 0) return std::nullopt;
  return control.value;
}

bool set(VideoDevice& device, std::uint32_t id, int value) {
  v4l2_control control{.id = id, .value = value};
  return device.control(VIDIOC_S_CTRL, &control) == 0;
}

double milliseconds_of(Duration time) {
  return 1e3 * seconds(time);
}

}  // namespace

std::optional<Duration> exposure_of(VideoDevice& device) {
  const auto value = value_of(device, V4L2_CID_EXPOSURE_ABSOLUTE);
  if (!value) return std::nullopt;
  return std::max(*value, 0) * Duration(exposure_unit);
}

bool has_automatic_exposure(VideoDevice& device) {
  const auto value = value_of(device, V4L2_CID_EXPOSURE_AUTO);
  return value && (*value == V4L2_EXPOSURE_AUTO || *value == V4L2_EXPOSURE_APERTURE_PRIORITY);
}

std::optional<double> frame_rate_of(VideoDevice& device) {
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (device.control(VIDIOC_G_PARM, &parameters) != 0) return std::nullopt;
  const v4l2_fract& time = parameters.parm.capture.timeperframe;
  if (time.numerator == 0 || time.denominator == 0) return std::nullopt;
  return static_cast<double>(time.denominator) / time.numerator;
}

void set_exposure(VideoDevice& device, const std::string& name, Duration exposure) {
  const std::string wanted = fmt::format("{:.1f} ms", milliseconds_of(exposure));
  // A camera without this control has no automatic exposure.
  (void)set(device, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL);
  const auto steps = static_cast<int>(std::lround(exposure / Duration(exposure_unit)));
  if (!set(device, V4L2_CID_EXPOSURE_ABSOLUTE, steps))
    throw InputError(name, 0, "a camera whose exposure cannot be set", wanted);
  const auto given = exposure_of(device);
  if (given && *given != steps * Duration(exposure_unit))
    throw InputError(name, 0, fmt::format("an exposure of {:.1f} ms", milliseconds_of(*given)), wanted);
}

void set_gain(VideoDevice& device, const std::string& name, int gain) {
  (void)set(device, V4L2_CID_AUTOGAIN, 0);
  for (const std::uint32_t id : std::array<std::uint32_t, 2>{V4L2_CID_GAIN, V4L2_CID_ANALOGUE_GAIN}) {
    if (!set(device, id, gain)) continue;
    const auto given = value_of(device, id);
    if (!given || *given == gain) return;
    throw InputError(name, 0, fmt::format("a gain of {}", *given), fmt::format("{}", gain));
  }
  throw InputError(name, 0, "a camera whose gain cannot be set", fmt::format("a gain of {}", gain));
}

void set_frame_rate(VideoDevice& device, const std::string& name, double rate_hz) {
  constexpr std::uint32_t thousandths = 1000;
  constexpr double tolerance = 0.01;
  const std::string wanted = fmt::format("{:.4g} frames a second", rate_hz);
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  parameters.parm.capture.timeperframe = {
      .numerator = thousandths,
      .denominator = static_cast<std::uint32_t>(std::lround(rate_hz * thousandths))};
  if (device.control(VIDIOC_S_PARM, &parameters) != 0)
    throw InputError(name, 0, "a camera whose frame rate cannot be set", wanted);
  const auto given_hz = frame_rate_of(device);
  if (!given_hz || std::abs(*given_hz - rate_hz) <= tolerance * rate_hz) return;
  throw InputError(name, 0, fmt::format("{:.4g} frames a second", *given_hz), wanted);
}

}  // namespace lodestar
