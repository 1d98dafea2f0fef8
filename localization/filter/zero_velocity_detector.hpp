#pragma once

#include <optional>

#include "maps/motion.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// Recognises a robot that stands. An encoder that has come to rest on the edge of a step reports one step to
/// and fro for as long as it stands; a filter that took that for travel would lose its certainty on the spot.
/// Travel beyond one step is never held back. A value type.
class ZeroVelocityDetector {
 public:
  explicit ZeroVelocityDetector(double wheel_step_m) : wheel_step_m_(wheel_step_m) {}

  /// The reading, with the wheels held where they came to rest. Stamps ascend.
  WheelTravel settled(const WheelTravel& reading);

  [[nodiscard]] bool standing() const { return standing_; }

 private:
  [[nodiscard]] bool rests(const WheelTravel& reading) const;

  double wheel_step_m_;
  std::optional<WheelTravel> rest_;  ///< where the wheels last began to rest
  bool standing_ = false;
};

}  // namespace lodestar
