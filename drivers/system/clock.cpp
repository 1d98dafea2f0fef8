#include "drivers/system/clock.hpp"

#include <ctime>

namespace lodestar {
namespace {

constexpr std::int64_t nanoseconds_per_second = 1'000'000'000;

}  // namespace

Stamp monotonic_now() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return Stamp(Duration(std::int64_t{time.tv_sec} * nanoseconds_per_second + time.tv_nsec));
}

Duration system_clock_offset() {
  const auto wall = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<Duration>(wall) - monotonic_now().time_since_epoch();
}

void sleep_until(Stamp stamp) {
  const std::int64_t since_boot = stamp.time_since_epoch().count();
  const timespec time{.tv_sec = since_boot / nanoseconds_per_second,
                      .tv_nsec = since_boot % nanoseconds_per_second};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);
}

}  // namespace lodestar
