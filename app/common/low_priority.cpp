#include "app/common/low_priority.hpp"

#include <sys/resource.h>
#include <unistd.h>

namespace lodestar {

void lower_priority_of_this_thread() {
  constexpr int niceness = 10;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), niceness);  // of this thread alone, on Linux
}

}  // namespace lodestar
