#include "tests/can/pulse.hpp"

#include <algorithm>
#include <sched.h>

#include "drivers/system/clock.hpp"

namespace lodestar {
namespace {

constexpr Duration period = std::chrono::milliseconds(5);
constexpr Duration usual_delay = std::chrono::milliseconds(1);

Duration overlap(Stamp begin, Stamp end, Stamp from, Stamp to) {
  return std::max(std::min(end, to) - std::max(begin, from), Duration::zero());
}

}  // namespace

Pulse::Pulse() : thread_([this] { beat(); }) {}

Pulse::~Pulse() = default;

void Pulse::beat() {
  const sched_param first{.sched_priority = 50};
  (void)sched_setscheduler(0, SCHED_FIFO, &first);
  const std::stop_token stop = thread_.get_stop_token();
  while (!stop.stop_requested()) {
    const Stamp due = monotonic_now() + period;
    sleep_until(due);
    const Stamp awake = monotonic_now();
    if (awake - due <= usual_delay) continue;
    const std::lock_guard lock(mutex_);
    pauses_.push_back({due, awake});
  }
}

Duration Pulse::lost(Stamp from, Stamp to) const {
  const std::lock_guard lock(mutex_);
  Duration sum{};
  for (const Pause& pause : pauses_) sum += overlap(pause.begin, pause.end, from, to);
  return sum;
}

Duration Pulse::longest_pause(Stamp from, Stamp to) const {
  const std::lock_guard lock(mutex_);
  Duration longest{};
  for (const Pause& pause : pauses_) longest = std::max(longest, overlap(pause.begin, pause.end, from, to));
  return longest;
}

const Pulse& pulse() {
  static const Pulse only;
  return only;
}

}  // namespace lodestar
