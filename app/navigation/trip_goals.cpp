#include "app/navigation/trip_goals.hpp"

#include <algorithm>

#include "control/zone_speed.hpp"

namespace lodestar {
namespace {

/// A path leads through each point on the way, and is planned anew where the robot is farther beside it
/// (RouteOptions::left_path_m).
constexpr double near_m = 0.2;

/// By how much more than at its nearest the robot must be away again; half of that where it passed at a
/// distance, so that a fix that moves the estimate by a centimetre or two is no passing. Chosen by hand.
constexpr double receded_m = 0.01;
constexpr double receded_share = 0.5;

}  // namespace

void TripGoals::append(std::span<const Goal> goals) {
  goals_.insert(goals_.end(), goals.begin(), goals.end());
}

void TripGoals::see(const Vec2& robot_m) {
  if (passed_ + 1 >= led_to_) return;  // the last one is not passed, but reached
  const double distance_m = (goals_[passed_].position_m - robot_m).norm();
  if (!nearest_m_ && distance_m > near_m) return;
  nearest_m_ = std::min(nearest_m_.value_or(distance_m), distance_m);
  if (distance_m <= *nearest_m_ + std::max(receded_m, receded_share * *nearest_m_)) return;
  ++passed_;
  nearest_m_.reset();
}

std::optional<double> TripGoals::limit_mps(const PoseEstimate& estimate, const DriveOptions& drive) const {
  constexpr double sigmas = 2.3;  // as margin_for_uncertainty
  const double unsure_m = sigmas * larger_sigma(estimate.covariance.topLeftCorner<2, 2>());
  double limit_mps = drive.max_forward_mps;
  double to_begin_m = -unsure_m;  // of the leg, at least: by straight lines
  Vec2 before_m = estimate.map_from_base.position_m;
  for (std::size_t i = passed_; i < goals_.size(); ++i) {
    if (goals_[i].max_mps) {
      const double leg_mps = commanded_mps(*goals_[i].max_mps, drive);
      limit_mps = std::min(limit_mps, i == passed_ ? leg_mps : speed_before(leg_mps, to_begin_m, drive));
    }
    to_begin_m += (goals_[i].position_m - before_m).norm();
    before_m = goals_[i].position_m;
  }
  return limit_mps < drive.max_forward_mps ? std::optional(limit_mps) : std::nullopt;
}

}  // namespace lodestar
