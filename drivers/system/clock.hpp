#pragma once

#include "maps/stamp.hpp"

namespace lodestar {

/// Robot time on real hardware: CLOCK_MONOTONIC, which cannot be set and is shared by all processes.
Stamp monotonic_now();

/// Sleeps until that time on the same clock; returns at once when it is past. A signal ends the sleep early.
void sleep_until(Stamp stamp);

/// What the system's clock, by which programs on several machines agree, is ahead of robot time at present.
/// It changes when somebody sets that clock.
Duration system_clock_offset();

}  // namespace lodestar
