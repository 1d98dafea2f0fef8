#include "app/navigation/rest.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace lodestar {

void RestDetector::add(Stamp now, const std::optional<BodyVelocity>& measured,
                       const std::optional<PoseEstimate>& estimate) {
  measured_ = measured;
  is_measured_quiet_ = measured && std::abs(measured->forward_mps) <= options_.still_mps &&
                       std::abs(measured->turn_radps) <= options_.still_radps;
  if (!estimate) return places_.clear();
  places_.push_back({now, estimate->map_from_base});
  while (places_.size() > 2 && places_[1].stamp <= now - options_.window) places_.pop_front();
}

bool RestDetector::is_estimate_still() const {
  if (places_.empty() || places_.back().stamp - places_.front().stamp < options_.window) return false;
  const Pose2& here = places_.back().map_from_base;
  return std::ranges::all_of(places_, [&](const Place& place) {
    return (place.map_from_base.position_m - here.position_m).norm() <= options_.moved_m &&
           std::abs(wrap_angle(place.map_from_base.yaw_rad - here.yaw_rad)) <= options_.turned_rad;
  });
}

std::string RestDetector::why_not() const {
  if (!measured_) return "the base measures no speed";
  return fmt::format("the base measures {:.0f} mm/s and {:.1f} deg/s, and the estimated pose moves",
                     1e3 * measured_->forward_mps, degrees(measured_->turn_radps));
}

}  // namespace lodestar
