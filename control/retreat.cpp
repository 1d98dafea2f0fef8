#include "control/retreat.hpp"

namespace lodestar {

void Retreat::saw_marker_at(const Vec2& position_in_map) {
  constexpr double step_m = 0.1;
  if (!seen_at_m_.empty() && (position_in_map - seen_at_m_.back()).norm() < step_m) return;
  seen_at_m_.push_back(position_in_map);
  while (static_cast<double>(seen_at_m_.size() - 1) * step_m > options_.before_last_m) seen_at_m_.pop_front();
}

std::optional<Vec2> Retreat::begin() {
  if (!possible()) return std::nullopt;
  ++made_;
  towards_m_ = seen_at_m_.front();
  return towards_m_;
}

}  // namespace lodestar
