#include "app/navigation/holding_points.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {

void HoldingPoints::stand_at(const Pose2& odom_from_base) {
  if (place_ && !has_gone_on(odom_from_base)) return;
  place_ = odom_from_base;
  by_what_stays_ = {};
  by_what_may_go_ = {};
}

bool HoldingPoints::has_gone_on(const Pose2& odom_from_base) const {
  return (odom_from_base.position_m - place_->position_m).norm() > options_.creeps_m ||
         std::abs(wrap_angle(odom_from_base.yaw_rad - place_->yaw_rad)) > options_.creeps_rad;
}

void HoldingPoints::add(const HoldingPoint& point, Stamp now) {
  Held& held = point.may_go ? by_what_may_go_ : by_what_stays_;
  if (held.last && now - *held.last <= options_.longest_between) held.lasts += now - *held.last;
  held.last = now;
  if (held.lasts < (point.may_go ? options_.after_if_it_may_go : options_.after)) return;
  std::erase_if(known_, [&](const Known& known) { return now - known.last > options_.kept; });
  const auto same = std::ranges::find_if(known_, [&](const Known& known) {
    return known.point.may_go == point.may_go &&
           (known.point.position_m - point.position_m).norm() <= options_.apart_m;
  });
  if (same == known_.end()) {
    known_.push_back({point, now});
  } else {
    same->last = now;
  }
}

std::vector<HoldingPoint> HoldingPoints::points(Stamp now) const {
  std::vector<HoldingPoint> points;
  for (const Known& known : known_)
    if (now - known.last <= options_.kept) points.push_back(known.point);
  return points;
}

}  // namespace lodestar
