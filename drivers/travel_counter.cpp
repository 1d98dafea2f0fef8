#include "drivers/travel_counter.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace lodestar {
namespace {

/// The shorter way round from one reading to the other, as two's complement gives it.
std::int32_t difference(std::int32_t newer, std::int32_t older) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(newer) - static_cast<std::uint32_t>(older));
}

constexpr double mm_per_m = 1000.0;
/// Frames are stamped on arrival, which may come late: a reading may hold this much more than its interval.
constexpr double stamp_slack_s = 0.1;

}  // namespace

std::optional<WheelTravel> TravelCounter::take(Stamp stamp, const agilex::Odometer& reading) {
  const auto last = std::exchange(last_, Reading{stamp, reading});
  if (last) {
    const std::int64_t left_mm = difference(reading.left_mm, last->odometer.left_mm);
    const std::int64_t right_mm = difference(reading.right_mm, last->odometer.right_mm);
    const double most_mm = mm_per_m * max_wheel_mps_ * (seconds(stamp - last->stamp) + stamp_slack_s);
    const auto farthest_mm = static_cast<double>(std::max(std::abs(left_mm), std::abs(right_mm)));
    if (stamp < last->stamp || farthest_mm > most_mm) return std::nullopt;
    left_mm_ += left_mm;
    right_mm_ += right_mm;
  }
  return WheelTravel{stamp, static_cast<double>(left_mm_) / mm_per_m,
                     static_cast<double>(right_mm_) / mm_per_m};
}

}  // namespace lodestar
