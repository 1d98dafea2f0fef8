#include "drivers/base/travel_counter.hpp"

#include <cmath>

namespace lodestar {
namespace {

/// Difference of two readings, wrapped (two's complement).
double difference(double newer, double older) {
  const auto steps =
      static_cast<std::uint32_t>(static_cast<std::int64_t>(newer) - static_cast<std::int64_t>(older));
  return static_cast<std::int32_t>(steps);
}

/// Frames are stamped on arrival, which may be late: a reading may cover this much more than its interval.
constexpr double stamp_slack_s = 0.05;

}  // namespace

std::optional<WheelTravel> TravelCounter::take(Stamp stamp, const agilex::Odometer& odometer) {
  return accumulate({stamp, static_cast<double>(odometer.left_mm), static_cast<double>(odometer.right_mm)},
                    difference);
}

std::optional<WheelTravel> TravelCounter::take(Stamp stamp, double left_mm, double right_mm) {
  return accumulate({stamp, left_mm, right_mm}, [](double newer, double older) { return newer - older; });
}

std::optional<WheelTravel> TravelCounter::accumulate(const Reading& reading, Difference difference) {
  if (!last_) last_ = reading;
  const auto follows = [&](const Reading& older) {
    const double most_mm = mm_per_m * max_wheel_mps_ * (seconds(reading.stamp - older.stamp) + stamp_slack_s);
    return reading.stamp >= older.stamp && std::abs(difference(reading.left_mm, older.left_mm)) <= most_mm &&
           std::abs(difference(reading.right_mm, older.right_mm)) <= most_mm;
  };
  // A single jump is a corrupted frame; if the next reading fits the jump, the base was restarted.
  if (!follows(*last_) && outlier_ && follows(*outlier_)) last_ = outlier_;
  if (!follows(*last_)) {
    outlier_ = reading;
    return std::nullopt;
  }
  left_mm_ += difference(reading.left_mm, last_->left_mm);
  right_mm_ += difference(reading.right_mm, last_->right_mm);
  last_ = reading;
  outlier_.reset();
  return WheelTravel{reading.stamp, left_mm_ / mm_per_m, right_mm_ / mm_per_m};
}

}  // namespace lodestar
