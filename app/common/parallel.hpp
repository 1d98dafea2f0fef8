#pragma once

#include <functional>

namespace lodestar {

/// Calls work(0) to work(count - 1) from as many threads as there are cores, in no order. The first exception
/// ends the work and is rethrown.
void in_parallel(int count, const std::function<void(int i)>& work);

}  // namespace lodestar
