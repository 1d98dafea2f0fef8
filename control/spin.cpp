#include "control/spin.hpp"

#include <cmath>

namespace lodestar {

std::optional<double> Spin::update(Stamp now, const std::optional<StopReason>& stop, double turned_rad) {
  if (!options_.allowed || !stop || !can_a_marker_end(*stop)) {
    stopped_since_.reset();
    begun_at_rad_.reset();
    return std::nullopt;
  }
  if (!stopped_since_) stopped_since_ = now;
  if (now - *stopped_since_ < options_.wait) return std::nullopt;
  if (!begun_at_rad_) begun_at_rad_ = turned_rad;
  if (std::abs(turned_rad - *begun_at_rad_) >= options_.most_turn_rad) return std::nullopt;
  return options_.turn_radps;
}

}  // namespace lodestar
