#pragma once

#include <cstdint>
#include <optional>

#include "drivers/agilex_v2.hpp"
#include "maps/motion.hpp"

namespace lodestar {

/// Turns the base's odometer, which wraps around at 32 bits of millimetres, into travel since the first
/// reading.
class TravelCounter {
 public:
  /// `max_wheel_mps` is far beyond what the base can do: a reading that would need more comes from a
  /// restarted base or a broken frame.
  explicit TravelCounter(double max_wheel_mps) : max_wheel_mps_(max_wheel_mps) {}

  /// Nothing when the wheels cannot have rolled that far since the last reading, or when it is older than
  /// that; travel then goes on from this reading and takes no leap.
  std::optional<WheelTravel> take(Stamp stamp, const agilex::Odometer& reading);

 private:
  struct Reading {
    Stamp stamp;
    agilex::Odometer odometer;
  };

  double max_wheel_mps_ = 0.0;
  std::optional<Reading> last_;
  std::int64_t left_mm_ = 0;
  std::int64_t right_mm_ = 0;
};

}  // namespace lodestar
