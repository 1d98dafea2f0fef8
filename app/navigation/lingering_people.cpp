#include "app/navigation/lingering_people.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace lodestar {
namespace {

/// Of a mean over about so long, for what is added after that.
double weight(Duration after, Duration of_mean) {
  return 1.0 - std::exp(-seconds(after) / seconds(of_mean));
}

}  // namespace

void LingeringPeople::add(std::span<FieldPoint> points, Stamp newest) {
  const auto is_map = [](const FieldPoint& point) { return point.presence == Presence::mapped; };
  const auto joins = [&](const FieldPoint& point, const FieldPoint& next) {
    return !is_map(point) && !is_map(next) &&
           (point.point_in_odom - next.point_in_odom).norm() <= options_.joins_m;
  };
  for (std::size_t first = 0, last = 0; first < points.size(); first = last) {
    for (last = first + 1; last < points.size() && joins(points[last - 1], points[last]);) ++last;
    if (!is_map(points[first])) follow(points.subspan(first, last - first), newest);
  }
  std::erase_if(people_,
                [&](const Someone& someone) { return newest - someone.seen > options_.longest_unseen; });
}

void LingeringPeople::follow(std::span<FieldPoint> piece, Stamp newest) {
  if ((piece.front().point_in_odom - piece.back().point_in_odom).norm() > options_.widest_m) return;
  std::vector<Vec2> hits_m;
  for (const FieldPoint& point : piece) hits_m.push_back(point.point_in_odom);
  const Vec2 sum_m = std::accumulate(hits_m.begin(), hits_m.end(), Vec2(Vec2::Zero()));
  const Vec2 middle_m = sum_m / static_cast<double>(hits_m.size());
  const bool has_moved =
      std::ranges::any_of(piece, [](const FieldPoint& point) { return point.presence == Presence::person; });
  Someone* someone = nearest(middle_m);
  if (someone == nullptr) {
    people_.push_back(
        {.place_m = middle_m, .since = newest, .seen = newest, .moved_share = 0.0, .hits_m = {}});
    someone = &people_.back();
  }
  const Duration after = newest - someone->seen;
  const double moved = has_moved ? 1.0 : 0.0;
  someone->moved_share += weight(after, options_.lately) * (moved - someone->moved_share);
  someone->place_m += weight(after, options_.follows_in) * (middle_m - someone->place_m);
  someone->seen = newest;
  someone->hits_m = std::move(hits_m);
  const bool stays =
      newest - someone->since >= options_.stays_from && someone->moved_share >= options_.walking_share;
  for (FieldPoint& point : piece) point.stays = stays;
}

/// Null where nobody has been.
LingeringPeople::Someone* LingeringPeople::nearest(const Vec2& middle_m) {
  const auto away_m = [&](const Someone& someone) { return (someone.place_m - middle_m).norm(); };
  const auto found = std::ranges::min_element(people_, {}, away_m);
  return found != people_.end() && away_m(*found) <= options_.stays_within_m ? &*found : nullptr;
}

std::vector<Vec2> LingeringPeople::hits_m(Stamp now) const {
  std::vector<Vec2> hits_m;
  for (const Someone& someone : people_) {
    const bool lingers = now - someone.since >= options_.lingers_from &&
                         now - someone.seen <= options_.longest_unseen &&
                         someone.moved_share >= options_.walking_share;
    if (lingers) hits_m.insert(hits_m.end(), someone.hits_m.begin(), someone.hits_m.end());
  }
  return hits_m;
}

}  // namespace lodestar
