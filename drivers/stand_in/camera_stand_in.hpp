#pragma once

#include <memory>
#include <string>

#include "drivers/camera/camera.hpp"
#include "maps/camera_model.hpp"
#include "maps/marker_registry.hpp"

namespace lodestar {

/// The simulated camera for a base that is simulated in another process (`lodestar base`), in real time. It
/// receives the robot's true pose from that process and delivers nothing but images. `interface` is the CAN
/// interface of that base; while there is no such base, no frames arrive.
std::unique_ptr<Camera> open_camera_stand_in(const std::string& interface, const MarkerRegistry& registry,
                                             const CameraModel& camera,
                                             const Eigen::Isometry3d& base_from_camera,
                                             std::uint64_t seed = 1);

}  // namespace lodestar
