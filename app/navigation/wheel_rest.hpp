#pragma once

#include <cmath>
#include <optional>
#include <span>

#include "maps/motion.hpp"

namespace lodestar {

struct WheelRestOptions {
  /// Of either wheel. Whole millimetres flicker by one; less within the window is slower than 4 mm/s.
  double most_travel_m = 0.0015;
  Duration window = std::chrono::milliseconds(400);
};

/// Whether the robot stands, by the travel of its wheels: unlike a measured speed, it is without noise at
/// rest.
class WheelRest {
 public:
  explicit WheelRest(const WheelRestOptions& options = {}) : options_(options) {}

  void take(std::span<const WheelTravel> travel) {
    for (const WheelTravel& reading : travel) {
      newest_ = reading.stamp;
      const bool has_moved = !since_ || std::abs(reading.left_m - since_->left_m) > options_.most_travel_m ||
                             std::abs(reading.right_m - since_->right_m) > options_.most_travel_m;
      if (has_moved) since_ = reading;
    }
  }

  /// True when neither wheel has turned within the window.
  [[nodiscard]] bool holds() const { return since_ && newest_ - since_->stamp >= options_.window; }

 private:
  WheelRestOptions options_;
  std::optional<WheelTravel> since_;  ///< the reading from which the wheels have not moved
  Stamp newest_;
};

}  // namespace lodestar
