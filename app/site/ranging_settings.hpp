#pragma once

#include "app/site/site.hpp"
#include "maps/strict_yaml.hpp"

// What measures ranges, as robot.yaml describes it. Throw InputError with file and line.
namespace lodestar {

RobotScanner read_scanner(StrictYaml yaml);

/// Its optical axis is turned by yaw, then down by pitch.
RobotDepthCamera read_depth_camera(StrictYaml yaml);

}  // namespace lodestar
