#pragma once

#include <optional>

#include "maps/motion.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// Zero-velocity detector (ZUPT). An encoder at rest on the edge of a step reports one step to and fro; a
/// filter that took this for travel would lose certainty while standing. Travel beyond one step passes at
/// once. A value type.
class ZeroVelocityDetector {
 public:
  explicit ZeroVelocityDetector(double wheel_step_m) : wheel_step_m_(wheel_step_m) {}

  /// The reading, with the wheels held where they came to rest. Stamps ascend.
  WheelTravel settled(const WheelTravel& reading);

  [[nodiscard]] bool standing() const { return standing_; }

 private:
  [[nodiscard]] bool rests(const WheelTravel& reading) const;

  double wheel_step_m_;
  std::optional<WheelTravel> rest_;  ///< reading at which the wheels last came to rest
  bool standing_ = false;
};

}  // namespace lodestar
