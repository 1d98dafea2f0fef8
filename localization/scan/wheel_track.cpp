#include "localization/scan/wheel_track.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

/// The pose at the end of an arc that begins at the identity: the chord lies along half the turn.
Pose2 along_arc(double length_m, double turn_rad) {
  const double half_rad = 0.5 * turn_rad;
  const double chord_m = std::abs(half_rad) < 1e-6 ? length_m : length_m * std::sin(half_rad) / half_rad;
  return {{chord_m * std::cos(half_rad), chord_m * std::sin(half_rad)}, turn_rad};
}

}  // namespace

void WheelTrack::add(const WheelTravel& travel) {
  if (marks_.empty()) {
    marks_.push_back({.travel = travel});
    return;
  }
  const Mark& last = marks_.back();
  if (travel.stamp <= last.travel.stamp) return;
  const double left_m = scales_.left * (travel.left_m - last.travel.left_m);
  const double right_m = scales_.right * (travel.right_m - last.travel.right_m);
  const double arc_m = 0.5 * (left_m + right_m);
  const double turn_rad = scales_.turn * (right_m - left_m) / options_.track_width_m;
  marks_.push_back({travel, last.odom_from_base * along_arc(arc_m, turn_rad), arc_m, turn_rad});
  while (marks_.size() > 2 && travel.stamp - marks_[1].travel.stamp >= options_.kept) marks_.pop_front();
}

void WheelTrack::use_scales(const TravelScales& scales) {
  const auto cut = [&](double scale) {
    return std::clamp(scale, 1.0 - options_.most_scale_change, 1.0 + options_.most_scale_change);
  };
  scales_ = {cut(scales.left), cut(scales.right), cut(scales.turn)};
}

std::optional<Pose2> WheelTrack::pose_at(Stamp stamp) const {
  if (marks_.empty() || stamp < marks_.front().travel.stamp) return std::nullopt;
  if (stamp > marks_.back().travel.stamp + options_.ahead) return std::nullopt;
  const auto after =
      std::ranges::lower_bound(marks_, stamp, {}, [](const Mark& mark) { return mark.travel.stamp; });
  if (after == marks_.begin()) return after->odom_from_base;
  // Ahead of the newest reading the last arc goes on.
  const bool is_ahead = after == marks_.end();
  const Mark& to = is_ahead ? marks_.back() : *after;
  if (is_ahead && marks_.size() == 1) return to.odom_from_base;
  const Mark& from = *(is_ahead ? after - 2 : after - 1);
  const double share = seconds(stamp - from.travel.stamp) / seconds(to.travel.stamp - from.travel.stamp);
  return from.odom_from_base * along_arc(share * to.arc_m, share * to.turn_rad);
}

BodyVelocity WheelTrack::velocity() const {
  if (marks_.size() < 2) return {};
  const Mark& last = marks_.back();
  const double during_s = seconds(last.travel.stamp - marks_[marks_.size() - 2].travel.stamp);
  return {last.arc_m / during_s, last.turn_rad / during_s};
}

}  // namespace lodestar
