#include "localization/filter/belief_history.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {

namespace {

/// Factor on the variance of each of a series of fixes with correlated errors (first-order Gauss-Markov
/// process): n fixes count as 1 + (n - 1) (1 - r) / (1 + r) independent ones, with r the correlation of
/// neighbours.
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
  const Stamp since = travel.stamp - belief_history;
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
  const std::optional<Belief> expected = at(travel, options);
  if (!expected || squared_distance(*expected, fix, options) > gate_squared_distance()) return false;
  PlanarFix weighed = fix;
  weighed.covariance += (variance_growth(std::chrono::abs(travel.stamp - last_fix_), options) - 1.0) *
                        (fix.covariance - fix.shared_covariance);
  last_fix_ = std::max(last_fix_, travel.stamp);
  put(corrected(*expected, weighed, options), options);
  return true;
}

bool BeliefHistory::set_keyframe(const WheelTravel& travel, double sway_m, const PoseFilterOptions& options) {
  const std::optional<Belief> expected = at(travel, options);
  if (!expected) return false;
  put(with_keyframe(*expected, sway_m, options), options);
  return true;
}

bool BeliefHistory::add_motion(const VisualOdometryIncrement& motion, const WheelTravel& travel,
                               bool becomes_keyframe, const PoseFilterOptions& options) {
  const std::optional<Belief> expected = at(travel, options);
  if (!expected || expected->keyframe_stamp != motion.from) return false;
  if (squared_distance(*expected, motion, options) > gate_squared_distance()) return false;
  VisualOdometryIncrement weighed = motion;
  weighed.sway_m *= std::sqrt(variance_growth(std::chrono::abs(travel.stamp - last_motion_), options));
  last_motion_ = std::max(last_motion_, travel.stamp);
  put(corrected(*expected, weighed, becomes_keyframe, options), options);
  return true;
}

/// Inserts the belief at its time and predicts the later ones from it.
void BeliefHistory::put(const Belief& belief, const PoseFilterOptions& options) {
  const auto later = std::ranges::upper_bound(beliefs_, belief.travel.stamp, {},
                                              [](const Belief& other) { return other.travel.stamp; });
  auto last = beliefs_.insert(later, belief);
  for (auto next = std::next(last); next != beliefs_.end(); last = next++)
    *next = moved(*last, next->travel, options);
}

}  // namespace lodestar
