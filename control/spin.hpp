#pragma once

#include <optional>

#include "control/safety_stop.hpp"

namespace lodestar {

struct SpinOptions {
  bool allowed = true;  ///< only a round robot, or one with clearance around it, may turn on the spot
  Duration wait = std::chrono::seconds(1);  ///< after the stop
  double turn_radps = 0.4;
  double most_turn_rad = radians(380.0);  ///< then the spin ends
};

/// Recovery behaviour of a lost robot: waits at rest, then spins slowly, once around at most, until it sees a
/// marker. A value type.
class Spin {
 public:
  explicit Spin(const SpinOptions& options = {}) : options_(options) {}

  /// The turn rate (rad/s) to command; nothing without a stop that a marker can end, while waiting, or after
  /// a full turn. `turned_rad`: cumulative, by wheel odometry.
  std::optional<double> update(Stamp now, const std::optional<StopReason>& stop, double turned_rad);

 private:
  SpinOptions options_;
  std::optional<Stamp> stopped_since_;
  std::optional<double> begun_at_rad_;
};

}  // namespace lodestar
