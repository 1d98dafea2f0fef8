#include "app/navigation/holding_points.hpp"

#include <algorithm>

namespace lodestar {

void HoldingPoints::update(Stamp now, const std::optional<Vec2>& held_by_m) {
  const Duration step = last_ ? now - *last_ : Duration::zero();
  last_ = now;
  if (!held_by_m) return;
  held_ += step;
  if (held_ < options_.after) return;
  std::erase_if(points_, [&](const Point& point) { return now - point.last > options_.kept; });
  const auto known = std::ranges::find_if(points_, [&](const Point& point) {
    return (point.position_m - *held_by_m).norm() <= options_.apart_m;
  });
  if (known == points_.end()) {
    points_.push_back({*held_by_m, now});
  } else {
    known->last = now;
  }
}

std::vector<Vec2> HoldingPoints::points_m(Stamp now) const {
  std::vector<Vec2> points_m;
  for (const Point& point : points_)
    if (now - point.last <= options_.kept) points_m.push_back(point.position_m);
  return points_m;
}

}  // namespace lodestar
