#include "localization/filter/belief_history.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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

constexpr auto stamp_of = [](const auto& moment) { return moment.belief.travel.stamp; };

}  // namespace

void BeliefHistory::add_travel(const WheelTravel& travel, const PoseFilterOptions& options) {
  moments_.push_back({moved(newest(), travel, options), {}});
  const Stamp since = travel.stamp - belief_history;
  while (moments_.size() > 1 && moments_[1].belief.travel.stamp <= since) moments_.pop_front();
}

std::optional<Belief> BeliefHistory::at(const WheelTravel& travel, const PoseFilterOptions& options) const {
  const auto later = std::ranges::upper_bound(moments_, travel.stamp, {}, stamp_of);
  if (later == moments_.begin()) return std::nullopt;
  return moved(std::prev(later)->belief, travel, options);
}

bool BeliefHistory::add_fix(const PlanarFix& fix, const WheelTravel& travel,
                            const PoseFilterOptions& options) {
  const std::optional<Belief> expected = at(travel, options);
  if (!expected || squared_distance(*expected, fix, options) > gate_squared_distance()) return false;
  PlanarFix weighed = fix;
  weighed.covariance += (variance_growth(std::chrono::abs(travel.stamp - last_fix_), options) - 1.0) *
                        (fix.covariance - fix.shared_covariance);
  last_fix_ = std::max(last_fix_, travel.stamp);
  put(*expected, std::move(weighed), options);
  return true;
}

bool BeliefHistory::set_keyframe(const WheelTravel& travel, double sway_m, const PoseFilterOptions& options) {
  const std::optional<Belief> expected = at(travel, options);
  if (!expected) return false;
  put(*expected, Keyframe{sway_m}, options);
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
  put(*expected, Motion{weighed, becomes_keyframe}, options);
  return true;
}

/// An increment from a keyframe that an older correction has replaced no longer applies.
Belief BeliefHistory::after(const Belief& expected, const Correction& correction,
                            const PoseFilterOptions& options) {
  if (const auto* fix = std::get_if<PlanarFix>(&correction)) return corrected(expected, *fix, options);
  if (const auto* keyframe = std::get_if<Keyframe>(&correction))
    return with_keyframe(expected, keyframe->sway_m, options);
  const auto* motion = std::get_if<Motion>(&correction);
  if (motion == nullptr || expected.keyframe_stamp != motion->increment.from) return expected;
  return corrected(expected, motion->increment, motion->becomes_keyframe, options);
}

/// Inserts the corrected belief at its time, predicts the later ones from it and corrects them as before.
void BeliefHistory::put(const Belief& expected, Correction correction, const PoseFilterOptions& options) {
  const auto later = std::ranges::upper_bound(moments_, expected.travel.stamp, {}, stamp_of);
  Belief belief = after(expected, correction, options);
  auto last = moments_.insert(later, {std::move(belief), std::move(correction)});
  for (auto next = std::next(last); next != moments_.end(); last = next++)
    next->belief = after(moved(last->belief, next->belief.travel, options), next->correction, options);
}

}  // namespace lodestar
