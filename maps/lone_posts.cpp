#include "maps/lone_posts.hpp"

#include <algorithm>
#include <cmath>

#include "maps/legs.hpp"
#include "maps/scan_pieces.hpp"

namespace lodestar {
namespace {

constexpr int wraps = 256;  ///< cells a side: those around all that can be told as legs

/// Rays at one thing follow each other, and end as close to each other as those at one leg.
std::vector<ScanPiece> things_at(const DeskewedScan& scan, std::span<const std::size_t> rays) {
  ScanPiece ascending(rays.begin(), rays.end());
  std::ranges::sort(ascending);
  const auto repeated = std::ranges::unique(ascending);
  ascending.erase(repeated.begin(), repeated.end());
  const auto goes_on = [&](std::size_t before, std::size_t i) {
    return (before + 1) % scan.rays.size() == i &&
           (scan.rays[before].end_m - scan.rays[i].end_m).norm() <= LegOptions{}.gap_m(scan.rays[i]);
  };
  std::vector<ScanPiece> things;
  for (const std::size_t i : ascending) {
    if (things.empty() || !goes_on(things.back().back(), i)) things.emplace_back();
    things.back().push_back(i);
  }
  join_over_seam(things, goes_on);
  return things;
}

/// As thick as it is wide, and no thinner than a leg. Its edges may be as far away as its middle, or nearer:
/// how far it is, the rays at its front tell.
LonePost measured(const DeskewedScan& scan, const ScanPiece& thing, double own_m) {
  constexpr double thinnest_m = 0.06;
  const Ray& first = scan.rays[thing.front()];
  const Vec2& last_m = scan.rays[thing.back()].end_m;
  const double radius_m = 0.5 * std::max((last_m - first.end_m).norm(), thinnest_m);
  const Vec2 way = (0.5 * (first.end_m + last_m) - first.origin_m).normalized();
  const std::size_t third = thing.size() / 3;
  double front_m = 0.0;
  for (std::size_t k = third; k < thing.size() - third; ++k)
    front_m += range_m(scan.rays[thing[k]]) / static_cast<double>(thing.size() - 2 * third);
  return {.middle_m = first.origin_m + (front_m + radius_m) * way, .reach_m = radius_m + own_m};
}

}  // namespace

LonePosts::LonePosts(const LonePostsOptions& options)
    : options_(options), places_(static_cast<std::size_t>(wraps) * wraps) {}

LonePosts::Place& LonePosts::place_at(Cell cell) {
  constexpr auto mask = static_cast<unsigned>(wraps - 1);
  Place& place =
      places_[(static_cast<unsigned>(cell.row) & mask) * wraps + (static_cast<unsigned>(cell.column) & mask)];
  if (place.cell != cell) place = {.cell = cell, .free_at = std::nullopt, .hit_at = std::nullopt};
  return place;
}

std::vector<LonePost> LonePosts::add(const DeskewedScan& scan, const RayFan& fan,
                                     std::span<const std::size_t> at_legs) {
  note_hits(scan);
  std::vector<LonePost> posts;
  for (const ScanPiece& rays : things_at(scan, at_legs)) {
    const LonePost thing = measured(scan, rays, options_.own_m);
    if (is_alone(thing, scan.newest, fan)) posts.push_back(thing);
  }
  return posts;
}

void LonePosts::note_hits(const DeskewedScan& scan) {
  const double within_m = LegOptions{}.within_m + options_.farthest_leg_m;
  for (const Ray& ray : scan.rays) {
    if (!ends_at_something(ray) || range_m(ray) > within_m) continue;
    Place& place = place_at(cell_at(ray.end_m / options_.cell_m));
    if (place.hit_at && ray.stamp - *place.hit_at <= options_.hit_again) place.free_at.reset();
    place.hit_at = ray.stamp;
  }
}

bool LonePosts::is_free(Place& place, Stamp now, const RayFan& fan) const {
  if (place.free_at && now - *place.free_at < options_.between_looks) return true;
  const Vec2 middle_m = options_.cell_m * center_of(place.cell);
  if (place.hit_at != now && fan.passes(middle_m, options_.would_hit_m, options_.before_end_m))
    place.free_at = now;
  return place.free_at && now - *place.free_at <= options_.places_remembered;
}

/// Looks at each place, also where one is not free: what is seen now counts later.
LonePosts::Beside LonePosts::beside(const LonePost& thing, Stamp now, const RayFan& fan) {
  const Vec2 reach = Vec2::Constant(options_.farthest_leg_m);
  const Cell low = cell_at((thing.middle_m - reach) / options_.cell_m);
  const Cell high = cell_at((thing.middle_m + reach) / options_.cell_m);
  Beside found = Beside::free;
  for (int row = low.row; row <= high.row; ++row) {
    for (int column = low.column; column <= high.column; ++column) {
      const Cell cell{column, row};
      const double away_m = (options_.cell_m * center_of(cell) - thing.middle_m).norm();
      if (away_m < thing.reach_m || away_m > options_.farthest_leg_m) continue;
      Place& place = place_at(cell);
      if (is_free(place, now, fan)) continue;
      const bool is_hit = !place.free_at && place.hit_at && now - *place.hit_at <= options_.hit_again;
      if (is_hit) found = Beside::taken;
      if (found == Beside::free) found = Beside::unknown;
    }
  }
  return found;
}

LonePosts::Known& LonePosts::known_at(const Vec2& middle_m, Stamp now) {
  constexpr double same_m = 0.1;  // two legs are farther apart
  std::erase_if(known_, [&](const Known& thing) { return now - thing.alone_at > options_.posts_remembered; });
  const auto is_same = [&](const Known& thing) { return (thing.middle_m - middle_m).norm() < same_m; };
  const auto same = std::ranges::find_if(known_, is_same);
  const Known fresh{.middle_m = middle_m, .since = now, .alone_at = now};
  if (same == known_.end()) return known_.emplace_back(fresh);
  if ((same->middle_m - middle_m).norm() > options_.stays_within_m) *same = fresh;
  return *same;
}

/// What was alone stays a post for a while, as long as nothing is seen beside it and it does not move.
bool LonePosts::is_alone(const LonePost& thing, Stamp now, const RayFan& fan) {
  Known& known = known_at(thing.middle_m, now);
  switch (beside(thing, now, fan)) {
    case Beside::taken:
      known.times_alone = 0;
      break;
    case Beside::unknown:
      break;
    case Beside::free:
      known.alone_at = now;
      ++known.times_alone;
      break;
  }
  return known.times_alone >= options_.times_alone && now - known.since >= options_.to_stay;
}

}  // namespace lodestar
