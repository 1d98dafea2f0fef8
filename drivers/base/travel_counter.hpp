#pragma once

#include <optional>

#include "drivers/base/agilex_v2.hpp"
#include "maps/motion.hpp"

namespace lodestar {

/// Turns readings of both wheels' positions into travel since the first reading.
class TravelCounter {
 public:
  /// `max_wheel_mps` is more than the base can do: a reading that would need that comes from a restarted base
  /// or a broken frame.
  explicit TravelCounter(double max_wheel_mps) : max_wheel_mps_(max_wheel_mps) {}

  // Nothing when the wheels cannot have rolled that far since the last reading, or when it is older than
  // that. Travel goes on from the last reading when the next one follows from it, else takes no leap and goes
  // on from where the readings are now.

  /// An odometer that wraps around at 32 bits of millimetres.
  std::optional<WheelTravel> take(Stamp stamp, const agilex::Odometer& odometer);
  /// Positions that do not wrap around.
  std::optional<WheelTravel> take(Stamp stamp, double left_mm, double right_mm);

 private:
  struct Reading {
    Stamp stamp;
    double left_mm = 0.0;
    double right_mm = 0.0;
  };

  using Difference = double (*)(double newer, double older);

  std::optional<WheelTravel> go_on(const Reading& reading, Difference difference);

  double max_wheel_mps_ = 0.0;
  std::optional<Reading> last_;   ///< that made sense
  std::optional<Reading> leapt_;  ///< since then, the last that did not
  double left_mm_ = 0.0;
  double right_mm_ = 0.0;
};

}  // namespace lodestar
