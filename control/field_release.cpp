#include "control/field_release.hpp"

#include <algorithm>

namespace lodestar {

double FieldRelease::released_mps(Stamp now, double allowed_mps) {
  while (!recent_.empty() && recent_.back().mps >= allowed_mps) recent_.pop_back();
  recent_.push_back({now, allowed_mps});
  while (now - recent_.front().stamp > options_.free_for) recent_.pop_front();
  const double risen_mps = released_mps_ + options_.rise_mps2 * seconds(now - last_);
  released_mps_ = std::min(recent_.front().mps, risen_mps);
  if (released_mps_ >= options_.unlimited_mps) released_mps_ = none_mps;
  last_ = now;
  return released_mps_;
}

double allowed_mps(const FieldLimit& limit, const BodyVelocity& wanted, const RobotShape& shape) {
  return limit.reason ? limit.share * outline_speed_mps(wanted, shape) : FieldRelease::none_mps;
}

BodyVelocity slowed_to(double outline_mps, const BodyVelocity& wanted, const RobotShape& shape) {
  const double wanted_mps = outline_speed_mps(wanted, shape);
  if (outline_mps <= 0.0) return {};
  if (wanted_mps <= outline_mps) return wanted;
  const double share = outline_mps / wanted_mps;
  return {share * wanted.forward_mps, share * wanted.turn_radps};
}

}  // namespace lodestar
