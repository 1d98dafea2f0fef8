#pragma once

#include <memory>
#include <string>

#include "drivers/camera/depth_camera.hpp"

namespace lodestar {

/// The depth camera at the given device node (`/dev/video2`), with Z16 images of this size, in millimetres.
/// It may be unplugged and come back. Throws InputError where it is missing at the start, or another.
std::unique_ptr<DepthCamera> open_v4l2_depth_camera(const std::string& device, int width_px, int height_px);

}  // namespace lodestar
