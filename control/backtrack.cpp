#include "control/backtrack.hpp"

namespace lodestar {
namespace {

constexpr double step_m = 0.1;

bool is_a_step_away(const Vec2& from_m, const Vec2& to_m) {
  return (to_m - from_m).norm() >= step_m;
}

}  // namespace

void Backtrack::saw_marker_at(const Vec2& position_in_map) {
  has_seen_ = true;
  found_no_marker_ = false;
  unseen_at_m_.clear();
  if (!seen_at_m_.empty() && !is_a_step_away(seen_at_m_.back(), position_in_map)) return;
  std::erase_if(blind_places_m_,
                [&](const Vec2& blind_m) { return !is_a_step_away(blind_m, position_in_map); });
  seen_at_m_.push_back(position_in_map);
  while (static_cast<double>(seen_at_m_.size() - 1) * step_m > options_.before_last_m) seen_at_m_.pop_front();
}

void Backtrack::saw_no_marker_at(const Vec2& position_in_map) {
  if (unseen_at_m_.empty() || is_a_step_away(unseen_at_m_.back(), position_in_map))
    unseen_at_m_.push_back(position_in_map);
}

std::optional<Vec2> Backtrack::begin() {
  if (!possible()) return std::nullopt;
  ++made_;
  has_seen_ = false;
  blind_places_m_.insert(blind_places_m_.end(), unseen_at_m_.begin(), unseen_at_m_.end());
  unseen_at_m_.clear();
  towards_m_ = seen_at_m_.front();
  return towards_m_;
}

}  // namespace lodestar
