#pragma once

#include <optional>

#include "control/safety_stop.hpp"

namespace lodestar {

struct SpinOptions {
  bool allowed = true;  ///< only a round robot, or one with room around it, may turn where it stands
  Duration wait = std::chrono::seconds(1);  ///< after the stop
  double turn_radps = 0.4;
  double most_turn_rad = radians(380.0);  ///< then the robot stays as it is
};

/// What a lost robot does to find itself again: it stands, then turns slowly on the spot, once around, until
/// it sees a marker. A value type.
class Spin {
 public:
  explicit Spin(const SpinOptions& options = {}) : options_(options) {}

  /// The turning speed (rad/s) to command; nothing while there is no reason to look around, or no more use.
  /// `turned_rad` is what the wheels say, cumulative.
  std::optional<double> update(Stamp now, const std::optional<StopReason>& stop, double turned_rad);

 private:
  SpinOptions options_;
  std::optional<Stamp> stopped_since_;
  std::optional<double> begun_at_rad_;
};

}  // namespace lodestar
