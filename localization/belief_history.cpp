#include "localization/belief_history.hpp"

#include <algorithm>

namespace lodestar {

void BeliefHistory::add_travel(const WheelTravel& travel, const PoseFilterOptions& options) {
  beliefs_.push_back(moved(beliefs_.back(), travel, options));
  const Stamp since = travel.stamp - options.history;
  while (beliefs_.size() > 1 && beliefs_[1].travel.stamp <= since) beliefs_.pop_front();
}

std::optional<Belief> BeliefHistory::at(const WheelTravel& travel, const PoseFilterOptions& options) const {
  const auto later = std::ranges::upper_bound(beliefs_, travel.stamp, {},
                                              [](const Belief& belief) { return belief.travel.stamp; });
  if (later == beliefs_.begin()) return std::nullopt;
  return moved(*std::prev(later), travel, options);
}

bool BeliefHistory::add_fix(const PlanarFix& fix, const WheelTravel& travel,
                            const PoseFilterOptions& options) {
  const auto later = std::ranges::upper_bound(beliefs_, travel.stamp, {},
                                              [](const Belief& belief) { return belief.travel.stamp; });
  if (later == beliefs_.begin()) return false;
  const Belief expected = moved(*std::prev(later), travel, options);
  if (squared_distance(expected, fix, options) > options.gate_chi2) return false;
  auto belief = beliefs_.insert(later, corrected(expected, fix, options));
  for (auto next = std::next(belief); next != beliefs_.end(); belief = next++)
    *next = moved(*belief, next->travel, options);
  return true;
}

}  // namespace lodestar
