#pragma once

#include <memory>

#include "app/site/site.hpp"
#include "drivers/camera/camera.hpp"

namespace lodestar {

/// Opens the camera named in site.yaml. Throws InputError when it names none, or an unknown kind.
std::unique_ptr<Camera> open_camera(const Site& site, const BaseConnection& base, std::uint64_t seed);

}  // namespace lodestar
