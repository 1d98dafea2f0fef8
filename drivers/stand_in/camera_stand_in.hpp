#pragma once

#include <memory>
#include <string>

#include "drivers/camera/camera.hpp"
#include "maps/camera_model.hpp"
#include "maps/marker_registry.hpp"

namespace lodestar {

/// The simulated camera for a base that is simulated in another process (`lodestar base`), in real time. It
/// hears from that process where the robot truly is, and hands out nothing but images. `interface` is the CAN
/// interface on which that base lives; until there is one, no image comes.
std::unique_ptr<Camera> open_camera_stand_in(const std::string& interface, const MarkerRegistry& registry,
                                             const CameraModel& camera,
                                             const Eigen::Isometry3d& base_from_camera,
                                             std::uint64_t seed = 1);

}  // namespace lodestar
