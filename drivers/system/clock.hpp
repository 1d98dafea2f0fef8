#pragma once

#include "maps/stamp.hpp"

namespace lodestar {

/// The robot's time in the real world: CLOCK_MONOTONIC, which no one can set and all processes share.
Stamp monotonic_now();

/// Sleeps until that time on the same clock; not at all when it is past. A signal ends it early.
void sleep_until(Stamp stamp);

}  // namespace lodestar
