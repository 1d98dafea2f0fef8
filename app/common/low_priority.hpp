#pragma once

namespace lodestar {

/// The calling thread gives way to the control loop from here on.
void lower_priority_of_this_thread();

}  // namespace lodestar
