#pragma once

#include <chrono>
#include <string>

namespace lodestar {

/// The time of day as people and other programs read it: UTC in ISO 8601, 2026-11-26T09:05:00Z. For records
/// only: nothing that drives the robot goes by it, since it may jump.
std::string utc_text(std::chrono::system_clock::time_point time = std::chrono::system_clock::now());

}  // namespace lodestar
