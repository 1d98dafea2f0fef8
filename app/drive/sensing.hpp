#pragma once

#include "app/navigation/navigation.hpp"
#include "drivers/camera/camera.hpp"
#include "drivers/camera/depth_camera.hpp"
#include "drivers/scanner/scanner.hpp"

namespace lodestar {

/// What has come in by now. At most two frames a control period; further ones wait for the next, so that
/// catching up does not delay commands. `scanner` and `depth`: null without one.
SensorInput sensed(Stamp now, BaseFeedback base, Camera& camera, Scanner* scanner, DepthCamera* depth);

}  // namespace lodestar
