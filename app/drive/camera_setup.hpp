#pragma once

#include <memory>

#include "app/site/site.hpp"
#include "drivers/camera/camera.hpp"
#include "drivers/camera/depth_camera.hpp"
#include "drivers/scanner/scanner.hpp"

namespace lodestar {

/// Opens the camera named in site.yaml. Throws InputError when it names none, or an unknown kind.
std::unique_ptr<Camera> open_camera(const Site& site, const BaseConnection& base, std::uint64_t seed);

/// Opens the scanner of a robot that has one: it does not drive without it. Null for one that has none.
/// Throws InputError when site.yaml names none for it.
std::unique_ptr<Scanner> scanner_of(const Site& site);

/// The same of the depth camera.
std::unique_ptr<DepthCamera> depth_camera_of(const Site& site);

}  // namespace lodestar
