#pragma once

#include <optional>
#include <string>

#include "drivers/camera/video_device.hpp"

// Settings of a V4L2 camera. What a camera does not take as it was asked is refused: the functions that set
// throw InputError, which names the camera `name`, what it gives instead and what was wanted.
namespace lodestar {

/// The exposure time, if the camera reports it.
std::optional<Duration> exposure_of(VideoDevice& device);
/// True while the camera chooses it by itself.
bool has_automatic_exposure(VideoDevice& device);
/// Frames a second, if the driver says.
std::optional<double> frame_rate_of(VideoDevice& device);

/// Switches automatic exposure off. V4L2 counts in steps of 0.1 ms.
void set_exposure(VideoDevice& device, const std::string& name, Duration exposure);
/// Switches automatic gain off. The unit is the driver's.
void set_gain(VideoDevice& device, const std::string& name, int gain);
void set_frame_rate(VideoDevice& device, const std::string& name, double rate_hz);

}  // namespace lodestar
