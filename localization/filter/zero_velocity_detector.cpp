#include "localization/filter/zero_velocity_detector.hpp"

#include <cmath>

namespace lodestar {
namespace {

/// Time without travel. Chosen by hand: a wheel at the slowest speed that moves a base (2 cm/s) passes a step
/// of 1 mm six times within it.
constexpr Duration standing_after = std::chrono::milliseconds(300);

}  // namespace

WheelTravel ZeroVelocityDetector::settled(const WheelTravel& reading) {
  if (!rest_ || !rests(reading)) {
    rest_ = reading;
    standing_ = false;
    return reading;
  }
  const bool stood = standing_;
  standing_ = reading.stamp - rest_->stamp >= standing_after;
  if (!standing_) return reading;
  if (!stood) {  // held at the present reading, so that coming to rest causes no jump
    rest_->left_m = reading.left_m;
    rest_->right_m = reading.right_m;
  }
  return {reading.stamp, rest_->left_m, rest_->right_m};
}

bool ZeroVelocityDetector::rests(const WheelTravel& reading) const {
  const double within_m = 1.01 * wheel_step_m_;  // readings are whole steps up to rounding
  return std::abs(reading.left_m - rest_->left_m) <= within_m &&
         std::abs(reading.right_m - rest_->right_m) <= within_m;
}

}  // namespace lodestar
