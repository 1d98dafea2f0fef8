#include "maps/leg_pairs.hpp"

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

/// What is near, split where neighbouring hits lie too far apart for one leg.
std::vector<Thing> near_things(const DeskewedScan& scan, const LegPairOptions& options) {
  std::vector<Thing> things;
  Thing thing;
  const auto end_thing = [&] {
    if (!thing.rays.empty()) things.push_back(measured(std::move(thing), scan));
    thing = {};
  };
  for (std::size_t i = 0; i < scan.rays.size(); ++i) {
    const Ray& ray = scan.rays[i];
    if (!ends_at_something(ray) || range_m(ray) > options.within_m) continue;
    const double gap_m = std::max(options.least_gap_m, options.gap_rad * range_m(ray));
    const bool joins = thing.rays.empty() || (ray.end_m - scan.rays[thing.rays.back()].end_m).norm() <= gap_m;
    if (!joins) end_thing();
    thing.rays.push_back(i);
  }
  end_thing();
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

}  // namespace

std::vector<std::size_t> leg_pairs(const DeskewedScan& scan, const LegPairOptions& options) {
  const std::vector<Thing> things = near_things(scan, options);
  const auto is_pair = [&](const Thing& a, const Thing& b) {
    return std::max(a.width_m, b.width_m) <= options.widest_leg_m &&
           (a.middle_m - b.middle_m).norm() <= options.farthest_pair_m && is_gap(a, b, scan);
  };
  std::vector<std::size_t> rays;
  for (std::size_t i = 0; i < things.size(); ++i) {
    for (const std::size_t after : {1U, 2U}) {  // between them a piece of the wall behind may be seen
      const Thing& other = things[(i + after) % things.size()];
      if (after >= things.size() || !is_pair(things[i], other)) continue;
      rays.insert(rays.end(), things[i].rays.begin(), things[i].rays.end());
      rays.insert(rays.end(), other.rays.begin(), other.rays.end());
    }
  }
  return rays;
}

}  // namespace lodestar
