#include "maps/legs.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

struct Thing {
  std::vector<std::size_t> rays;
  Vec2 middle_m = Vec2::Zero();
  double width_m = 0.0;
};

double range_m(const Ray& ray) {
  return (ray.end_m - ray.origin_m).norm();
}

Thing measured(Thing thing, const DeskewedScan& scan) {
  const Vec2& first_m = scan.rays[thing.rays.front()].end_m;
  const Vec2& last_m = scan.rays[thing.rays.back()].end_m;
  thing.middle_m = 0.5 * (first_m + last_m);
  thing.width_m = (last_m - first_m).norm();
  return thing;
}

/// What is near, split where neighbouring hits lie too far apart for one leg. A turn may begin in the middle
/// of a thing.
std::vector<Thing> near_things(const DeskewedScan& scan, const LegOptions& options) {
  const auto joins = [&](std::size_t before, std::size_t ray) {
    const double gap_m = std::max(options.least_gap_m, options.gap_rad * range_m(scan.rays[ray]));
    return (scan.rays[ray].end_m - scan.rays[before].end_m).norm() <= gap_m;
  };
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < scan.rays.size(); ++i) {
    const Ray& ray = scan.rays[i];
    if (!ends_at_something(ray) || range_m(ray) > options.within_m) continue;
    if (groups.empty() || !joins(groups.back().back(), i)) groups.emplace_back();
    groups.back().push_back(i);
  }
  if (groups.size() > 1 && joins(groups.back().back(), groups.front().front())) {
    groups.back().insert(groups.back().end(), groups.front().begin(), groups.front().end());
    groups.erase(groups.begin());
  }
  std::vector<Thing> things;
  for (std::vector<std::size_t>& rays : groups) things.push_back(measured({.rays = std::move(rays)}, scan));
  return things;
}

/// Do all rays between them, and at least one, look past both? At the edge of a box hits lie far apart too.
bool is_gap(const Thing& from, const Thing& to, const DeskewedScan& scan) {
  constexpr double behind_m = 0.1;
  const std::size_t count = scan.rays.size();
  const std::size_t first = (from.rays.back() + 1) % count;
  const std::size_t last = to.rays.front();
  const double beyond_m = std::max(range_m(scan.rays[from.rays.back()]), range_m(scan.rays[last])) + behind_m;
  if ((last + count - first) % count > count / 4) return false;  // the long way round
  for (std::size_t i = first; i != last; i = (i + 1) % count)
    if (scan.rays[i].echo == Echo::invalid || range_m(scan.rays[i]) < beyond_m) return false;
  return first != last;
}

/// Do some rays on either side look past it? Of those beside a piece of the wall that is seen between two
/// things the first may come back from neither: what they graze is seen badly.
bool is_alone(const Thing& thing, const DeskewedScan& scan) {
  constexpr double behind_m = 0.1;
  constexpr std::size_t beside = 3;
  const std::size_t count = scan.rays.size();
  const auto looks_past = [&](std::size_t i, std::size_t edge) {
    const Ray& ray = scan.rays[i % count];
    return ray.echo != Echo::invalid && range_m(ray) > range_m(scan.rays[edge]) + behind_m;
  };
  const std::size_t first = thing.rays.front();
  const std::size_t last = thing.rays.back();
  for (std::size_t k = 1; k <= beside; ++k)
    if (!looks_past(first + count - k, first) || !looks_past(last + k, last)) return false;
  return true;
}

}  // namespace

std::vector<std::size_t> rays_at_legs(const DeskewedScan& scan, const LegOptions& options) {
  const std::vector<Thing> things = near_things(scan, options);
  const auto is_thin = [&](const Thing& thing) { return thing.width_m <= options.widest_leg_m; };
  const auto is_pair = [&](const Thing& a, const Thing& b) {
    return is_thin(a) && is_thin(b) && (a.middle_m - b.middle_m).norm() <= options.farthest_pair_m &&
           is_gap(a, b, scan);
  };
  std::vector<std::size_t> rays;
  const auto append = [&](const Thing& thing) {
    rays.insert(rays.end(), thing.rays.begin(), thing.rays.end());
  };
  for (std::size_t i = 0; i < things.size(); ++i) {
    if (is_thin(things[i]) && is_alone(things[i], scan)) append(things[i]);
    for (const std::size_t after : {1U, 2U}) {  // between them a piece of the wall behind may be seen
      const Thing& other = things[(i + after) % things.size()];
      if (after >= things.size() || !is_pair(things[i], other)) continue;
      append(things[i]);
      append(other);
    }
  }
  return rays;
}

}  // namespace lodestar
