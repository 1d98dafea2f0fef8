#pragma once

#include <memory>

#include "app/site/site.hpp"
#include "drivers/camera/camera.hpp"

namespace lodestar {

/// The camera that the site says is mounted. Throws InputError when it says none that is known.
std::unique_ptr<Camera> open_camera(const Site& site, const BaseConnection& base, std::uint64_t seed);

}  // namespace lodestar
