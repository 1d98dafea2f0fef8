#include "maps/legs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "maps/scan_pieces.hpp"

namespace lodestar {
namespace {

struct Thing {
  ScanPiece rays;
  Vec2 middle_m = Vec2::Zero();
  double width_m = 0.0;
};

Thing measured(Thing thing, const DeskewedScan& scan) {
  const Vec2& first_m = scan.rays[thing.rays.front()].end_m;
  const Vec2& last_m = scan.rays[thing.rays.back()].end_m;
  thing.middle_m = 0.5 * (first_m + last_m);
  thing.width_m = (last_m - first_m).norm();
  return thing;
}

/// What is near, split where neighbouring hits lie too far apart for one leg.
std::vector<Thing> near_things(const DeskewedScan& scan, const LegOptions& options) {
  const auto is_near = [&](const Ray& ray) { return range_m(ray) <= options.within_m; };
  const auto joins = [&](const Ray& before, const Ray& ray) {
    return (ray.end_m - before.end_m).norm() <= options.gap_m(ray);
  };
  std::vector<ScanPiece> pieces = pieces_of(scan, is_near, joins);
  join_over_seam(
      pieces, [&](std::size_t last, std::size_t first) { return joins(scan.rays[last], scan.rays[first]); });
  std::vector<Thing> things;
  for (ScanPiece& rays : pieces) things.push_back(measured({.rays = std::move(rays)}, scan));
  return things;
}

/// Apart there, where all rays around lie at even angles.
double between_rays_m(const DeskewedScan& scan, double range_m) {
  return range_m * 2.0 * std::numbers::pi / static_cast<double>(scan.rays.size());
}

/// Of so many rays side by side, until `enough` end farther away than `past_m`: how many do? Nothing when one
/// does not, or when those that were lost leave room for a thing.
template <typename RayAt>
std::optional<std::size_t> looking_past(const RayAt& ray_at, std::size_t rays, std::size_t enough,
                                        double past_m, double apart_m) {
  std::size_t past = 0;
  int lost = 0;  // in a row
  for (std::size_t i = 0; i < rays && past < enough; ++i) {
    const Ray& ray = ray_at(i);
    if (ray.echo == Echo::invalid) {
      if ((++lost + 1) * apart_m > thin_thing_m) return std::nullopt;
      continue;
    }
    if (range_m(ray) <= past_m) return std::nullopt;
    lost = 0;
    ++past;
  }
  return past;
}

/// Do all rays between them, and at least one, look past both? At the edge of a box hits lie far apart too.
bool is_gap(const Thing& from, const Thing& to, const DeskewedScan& scan) {
  constexpr double behind_m = 0.1;
  const std::size_t count = scan.rays.size();
  const std::size_t first = (from.rays.back() + 1) % count;
  const std::size_t last = to.rays.front();
  const double farther_m = std::max(range_m(scan.rays[from.rays.back()]), range_m(scan.rays[last]));
  const std::size_t between = (last + count - first) % count;
  if (between > count / 4) return false;  // the long way round
  const auto ray_between = [&](std::size_t i) -> const Ray& { return scan.rays[(first + i) % count]; };
  return looking_past(ray_between, between, between, farther_m + behind_m, between_rays_m(scan, farther_m))
             .value_or(0) > 0;
}

enum class Side : std::uint8_t { before, after };

/// How far behind its edge, and behind what is seen of another beside it, must a thing's neighbours end, and
/// how wide may that other be?
struct Room {
  double behind_m = 0.0;
  double sliver_m = 0.0;
};

/// Do some rays beside it look past it? Of those beside a piece of the wall that is seen between two things
/// the first may come back from neither: what they graze is seen badly.
bool is_free(const Thing& thing, Side side, const Room& room, const DeskewedScan& scan) {
  constexpr std::size_t beside = 3;
  const std::size_t count = scan.rays.size();
  const std::size_t edge = side == Side::before ? thing.rays.front() : thing.rays.back();
  const auto ray_beside = [&](std::size_t k) -> const Ray& {
    return scan.rays[(side == Side::before ? edge + count - k : edge + k) % count];
  };
  const double edge_m = range_m(scan.rays[edge]);
  const double apart_m = between_rays_m(scan, edge_m);
  const auto most_slivers = std::min(static_cast<std::size_t>(room.sliver_m / apart_m), count - 1);
  double past_m = edge_m + room.behind_m;
  const auto looks_past = [&](const Ray& ray) { return ray.echo != Echo::invalid && range_m(ray) > past_m; };
  std::size_t first = 1;
  for (; first <= most_slivers && !looks_past(ray_beside(first)); ++first)
    if (ends_at_something(ray_beside(first)))
      past_m = std::max(past_m, range_m(ray_beside(first)) + room.behind_m);
  const auto ray_after = [&](std::size_t i) -> const Ray& { return ray_beside(first + i); };
  return looking_past(ray_after, count - first, beside, past_m, apart_m) == beside;
}

}  // namespace

RaysAtLegs rays_at_legs(const DeskewedScan& scan, const LegOptions& options) {
  const std::vector<Thing> things = near_things(scan, options);
  const auto is_thin = [&](const Thing& thing) { return thing.width_m <= options.widest_leg_m; };
  const auto is_alone = [&](const Thing& thing, const Room& room) {
    return is_thin(thing) && is_free(thing, Side::before, room, scan) &&
           is_free(thing, Side::after, room, scan);
  };
  const auto is_pair = [&](const Thing& a, const Thing& b) {
    return is_thin(a) && is_thin(b) && (a.middle_m - b.middle_m).norm() <= options.farthest_pair_m &&
           is_gap(a, b, scan);
  };
  const auto is_pair_alone = [&](const Thing& a, const Thing& b) {
    return is_free(a, Side::before, {.behind_m = options.aside_m}, scan) &&
           is_free(b, Side::after, {.behind_m = options.aside_m}, scan);
  };
  RaysAtLegs result;
  const auto append = [&](const Thing& thing, bool is_likely) {
    result.possible.insert(result.possible.end(), thing.rays.begin(), thing.rays.end());
    if (is_likely) result.likely.insert(result.likely.end(), thing.rays.begin(), thing.rays.end());
  };
  for (std::size_t i = 0; i < things.size(); ++i) {
    const bool is_likely = is_alone(things[i], {options.alone_before_m, options.sliver_m});
    if (is_likely || is_alone(things[i], {.behind_m = options.perhaps_alone_before_m}))
      append(things[i], is_likely);
    for (const std::size_t after : {1U, 2U}) {  // between them a piece of the wall behind may be seen
      const Thing& other = things[(i + after) % things.size()];
      if (after >= things.size() || !is_pair(things[i], other)) continue;
      const bool is_likely_pair = is_pair_alone(things[i], other);
      append(things[i], is_likely_pair);
      append(other, is_likely_pair);
    }
  }
  return result;
}

}  // namespace lodestar
