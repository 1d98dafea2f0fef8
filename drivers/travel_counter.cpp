#include "drivers/travel_counter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lodestar {
namespace {

/// The shorter way round from one reading to the other, as two's complement gives it.
double difference(double newer, double older) {
  const auto steps =
      static_cast<std::uint32_t>(static_cast<std::int64_t>(newer) - static_cast<std::int64_t>(older));
  return static_cast<std::int32_t>(steps);
}

constexpr double mm_per_m = 1000.0;
/// Frames are stamped on arrival, which may come late: a reading may hold this much more than its interval.
constexpr double stamp_slack_s = 0.1;

}  // namespace

std::optional<WheelTravel> TravelCounter::take(Stamp stamp, const agilex::Odometer& odometer) {
  const Reading reading{stamp, static_cast<double>(odometer.left_mm), static_cast<double>(odometer.right_mm)};
  if (!last_) return go_on(reading, 0.0, 0.0);
  return go_on(reading, difference(reading.left_mm, last_->left_mm),
               difference(reading.right_mm, last_->right_mm));
}

std::optional<WheelTravel> TravelCounter::take(Stamp stamp, double left_mm, double right_mm) {
  const Reading reading{stamp, left_mm, right_mm};
  if (!last_) return go_on(reading, 0.0, 0.0);
  return go_on(reading, left_mm - last_->left_mm, right_mm - last_->right_mm);
}

std::optional<WheelTravel> TravelCounter::go_on(const Reading& reading, double left_mm, double right_mm) {
  const auto last = std::exchange(last_, reading);
  if (last) {
    const double most_mm = mm_per_m * max_wheel_mps_ * (seconds(reading.stamp - last->stamp) + stamp_slack_s);
    const double farthest_mm = std::max(std::abs(left_mm), std::abs(right_mm));
    if (reading.stamp < last->stamp || farthest_mm > most_mm) return std::nullopt;
  }
  left_mm_ += left_mm;
  right_mm_ += right_mm;
  return WheelTravel{reading.stamp, left_mm_ / mm_per_m, right_mm_ / mm_per_m};
}

}  // namespace lodestar
