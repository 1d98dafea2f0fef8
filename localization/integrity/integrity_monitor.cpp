#include "localization/integrity/integrity_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace lodestar {

/// Of the two wheels the one that rolled farther counts: the other's encoder may be stuck.
void IntegrityMonitor::add_travel(const WheelTravel& reading) {
  if (last_travel_) {
    rolled_m_ += std::max(std::abs(reading.left_m - last_travel_->left_m),
                          std::abs(reading.right_m - last_travel_->right_m));
  }
  last_travel_ = reading;
  rolled_.push_back({reading.stamp, rolled_m_});
  while (rolled_.size() > 2 && rolled_[1].stamp <= reading.stamp - belief_history) rolled_.pop_front();
}

/// Several fixes may arrive between two readings of the wheels, late and at once: the distance counts at the
/// exposure, not on arrival.
double IntegrityMonitor::rolled_until_m(Stamp stamp) const {
  const auto after = std::ranges::lower_bound(rolled_, stamp, {}, &Rolled::stamp);
  if (after == rolled_.end()) return rolled_m_;
  if (after == rolled_.begin()) return after->distance_m;
  const Rolled& before = *std::prev(after);
  return std::lerp(before.distance_m, after->distance_m,
                   seconds(stamp - before.stamp) / seconds(after->stamp - before.stamp));
}

void IntegrityMonitor::add_fix(const FixVerdict& fix) {
  switch (fix.outcome) {
    case FixOutcome::accepted:
      return agree(fix);
    case FixOutcome::started:
      if (!may_start_by(fix)) latched_ = IntegrityAlarm::carried_away;
      failure_.reset();
      return agree(fix);
    case FixOutcome::relocated:
      if (is_gross(fix)) latched_ = IntegrityAlarm::carried_away;
      moved_at_ = fix.stamp;
      return agree(fix);
    case FixOutcome::refused_gate:
      return contradict(fix);
    case FixOutcome::collecting:
    case FixOutcome::refused_late:
      return;
  }
}

void IntegrityMonitor::agree(const FixVerdict& fix) {
  gross_in_a_row_ = 0;
  witnesses_.clear();
  rolled_at_agreement_m_ = rolled_m_;
  agreed_ = Waypoint{fix.map_from_base.position_m, rolled_until_m(fix.stamp)};
}

void IntegrityMonitor::contradict(const FixVerdict& fix) {
  const double rolled_m = rolled_until_m(fix.stamp);
  gross_in_a_row_ = is_gross(fix) ? gross_in_a_row_ + 1 : 0;
  if (!fix.expected || fix.ids.empty()) return;
  const Pose2 map_from_estimated = fix.map_from_base * inverse(*fix.expected);
  // Other markers show another error where the registry is not quite true: only the same ones are compared.
  std::vector<int> who(fix.ids.begin(), fix.ids.end());
  std::ranges::sort(who);
  const auto [witness, is_new] =
      witnesses_.try_emplace(std::move(who), Witness{map_from_estimated, rolled_m, is_beyond_wheels(fix)});
  if (is_new) return;
  const Witness& first = witness->second;
  const double apart_m =
      (map_from_estimated * fix.expected->position_m - first.map_from_estimated * fix.expected->position_m)
          .norm();
  const double turned_rad =
      std::abs(wrap_angle(map_from_estimated.yaw_rad - first.map_from_estimated.yaw_rad));
  if (apart_m <= options_.steady_m && turned_rad <= options_.steady_rad) return;
  if (rolled_m - first.rolled_m < options_.rolled_m) {
    latched_ = IntegrityAlarm::carried_away;
  } else {
    register_odometry_failure(fix);
  }
}

void IntegrityMonitor::register_odometry_failure(const FixVerdict& fix) {
  failure_is_new_ = true;
  failure_ = OdometryFailure{.estimated = {fix.expected->position_m, rolled_m_}};
  for (const auto& [ids, witness] : witnesses_)
    if (witness.is_out_of_reach) failure_->ids_out_of_reach.insert(ids.begin(), ids.end());
  witnesses_.clear();
  gross_in_a_row_ = 0;
  std::erase_if(wheel_errors_, [&](Stamp error) { return fix.stamp - error > options_.memory; });
  wheel_errors_.push_back(fix.stamp);
  if (wheel_errors_.size() >= options_.most_wheel_errors) latched_ = IntegrityAlarm::wheels_broken;
}

bool IntegrityMonitor::is_gross(const FixVerdict& fix) const {
  return fix.expected &&
         ((fix.map_from_base.position_m - fix.expected->position_m).norm() > options_.gross_m ||
          std::abs(wrap_angle(fix.map_from_base.yaw_rad - fix.expected->yaw_rad)) > options_.gross_rad);
}

/// Since the last agreement, the robot cannot have gone farther than its wheels have rolled.
bool IntegrityMonitor::is_beyond_wheels(const FixVerdict& fix) const {
  return agreed_ && (fix.map_from_base.position_m - agreed_->position_m).norm() >
                        rolled_until_m(fix.stamp) - agreed_->rolled_m + options_.steady_m;
}

/// After an odometry failure, a new belief cannot start farther away than the wheels have rolled since, nor
/// by markers alone that were out of reach when they began to contradict. Otherwise a marker is displaced, or
/// the robot was carried.
bool IntegrityMonitor::may_start_by(const FixVerdict& fix) const {
  if (!failure_) return true;
  const Waypoint& estimated = failure_->estimated;
  const bool is_near = (fix.map_from_base.position_m - estimated.position_m).norm() <=
                       rolled_m_ - estimated.rolled_m + options_.gross_m;
  const auto was_in_reach = [this](int id) { return !failure_->ids_out_of_reach.contains(id); };
  return is_near && std::ranges::any_of(fix.ids, was_in_reach);
}

bool IntegrityMonitor::take_odometry_failure() {
  return std::exchange(failure_is_new_, false);
}

std::optional<IntegrityAlarm> IntegrityMonitor::alarm(Stamp now) const {
  if (latched_) return latched_;
  if (gross_in_a_row_ >= options_.gross_fixes_to_stop) return IntegrityAlarm::contradicted;
  if (!wheel_errors_.empty() && now - wheel_errors_.back() <= options_.calm)
    return IntegrityAlarm::wheels_wrong;
  if (moved_at_ && now - *moved_at_ <= options_.calm) return IntegrityAlarm::moved;
  return std::nullopt;
}

}  // namespace lodestar
