#pragma once

#include <optional>

#include "drivers/base/agilex_v2.hpp"
#include "maps/motion.hpp"

namespace lodestar {

/// Converts position readings of both wheels into travel since the first reading.
class TravelCounter {
 public:
  /// `max_wheel_mps` is above the base's top speed: a reading that would require more comes from a restarted
  /// base or a corrupted frame.
  explicit TravelCounter(double max_wheel_mps) : max_wheel_mps_(max_wheel_mps) {}

  // Empty when the wheels cannot have rolled that far since the last reading, or when the reading is older
  // than that one. The jump is not added: travel continues from the last plausible reading when the next one
  // fits it, otherwise from the new readings.

  /// For an odometer of 32-bit millimetres that wraps around.
  std::optional<WheelTravel> take(Stamp stamp, const agilex::Odometer& odometer);
  /// For positions that do not wrap around.
  std::optional<WheelTravel> take(Stamp stamp, double left_mm, double right_mm);

 private:
  struct Reading {
    Stamp stamp;
    double left_mm = 0.0;
    double right_mm = 0.0;
  };

  using Difference = double (*)(double newer, double older);

  std::optional<WheelTravel> accumulate(const Reading& reading, Difference difference);

  double max_wheel_mps_ = 0.0;
  std::optional<Reading> last_;     ///< last plausible reading
  std::optional<Reading> outlier_;  ///< last implausible reading since then
  double left_mm_ = 0.0;
  double right_mm_ = 0.0;
};

}  // namespace lodestar
