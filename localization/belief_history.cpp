#include "localization/belief_history.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {

namespace {

/// By how much the variance of one of a series of fixes must grow so that the series says no more than its
/// errors, a first-order Gauss-Markov process, let it: n of them are worth 1 + (n - 1) (1 - r) / (1 + r)
/// independent ones, r the correlation of neighbours.
double variance_growth(Duration between_fixes, const PoseFilterOptions& options) {
  if (options.fix_correlation <= Duration::zero()) return 1.0;
  constexpr double least_s = 1e-3;  // fixes of one time are one fix
  const double apart_s = std::max(seconds(between_fixes), least_s);
  const double correlation = std::exp(-apart_s / seconds(options.fix_correlation));
  return (1.0 + correlation) / (1.0 - correlation);
}

}  // namespace

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
  PlanarFix weighed = fix;
  weighed.covariance *= variance_growth(std::chrono::abs(travel.stamp - last_fix_), options);
  last_fix_ = std::max(last_fix_, travel.stamp);
  auto belief = beliefs_.insert(later, corrected(expected, weighed, options));
  for (auto next = std::next(belief); next != beliefs_.end(); belief = next++)
    *next = moved(*belief, next->travel, options);
  return true;
}

}  // namespace lodestar
