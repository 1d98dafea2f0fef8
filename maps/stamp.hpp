#pragma once

#include <chrono>

namespace lodestar {

/// Clock type of robot time. It has no now(): only drivers read clocks, everywhere else time arrives with the
/// data.
struct RobotClock {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = std::chrono::nanoseconds;
  using time_point = std::chrono::time_point<RobotClock>;
  static constexpr bool is_steady = true;
};

using Duration = RobotClock::duration;
using Stamp = RobotClock::time_point;

constexpr double seconds(Duration duration) {
  return std::chrono::duration<double>(duration).count();
}
constexpr double seconds(Stamp stamp) {
  return seconds(stamp.time_since_epoch());
}
constexpr Duration from_seconds(double value_s) {
  return std::chrono::round<Duration>(std::chrono::duration<double>(value_s));
}

}  // namespace lodestar
