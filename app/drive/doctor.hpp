#pragma once

#include <vector>

#include "app/drive/finding.hpp"
#include "app/site/base_setup.hpp"

namespace lodestar {

/// Diagnoses why a robot does not move: checks the site, the CAN interface, the base, the camera and the
/// scanner, listening for one second. Sends nothing, so it may run during a drive.
std::vector<Finding> examine(const Site& site, const BaseConnection& connection);

}  // namespace lodestar
