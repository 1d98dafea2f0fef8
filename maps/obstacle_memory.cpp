#include "maps/obstacle_memory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "maps/legs.hpp"
#include "maps/occupancy_map.hpp"
#include "maps/smoothed_ends.hpp"

namespace lodestar {
namespace {

constexpr int wraps = 512;  ///< cells a side of the index; twice the half extent must be less

std::size_t wrapped(int column, int row) {
  constexpr auto mask = static_cast<unsigned>(wraps - 1);
  return (static_cast<unsigned>(row) & mask) * wraps + (static_cast<unsigned>(column) & mask);
}

bool is_part_of(const Vec2& hit_m, const LonePost& post) {
  return (hit_m - post.middle_m).norm() <= post.reach_m;
}

}  // namespace

ObstacleMemory::ObstacleMemory(const ObstacleMemoryOptions& options)
    : options_(options),
      half_cells_(std::clamp(static_cast<int>(options.half_extent_m / options.cell_m), 1, wraps / 2 - 1)),
      index_(static_cast<std::size_t>(wraps) * wraps, -1) {}

ObstacleMemory::Place ObstacleMemory::place_of(const Vec2& point_m) const {
  const Cell cell = cell_at(point_m / options_.cell_m);
  return {cell.column, cell.row};
}

Vec2 ObstacleMemory::center_m(Place place) const {
  return options_.cell_m * Vec2(place.column + 0.5, place.row + 0.5);
}

const ObstacleMemory::Seen* ObstacleMemory::at(Place place) const {
  const std::int32_t index = index_[wrapped(place.column, place.row)];
  if (index < 0) return nullptr;
  const Seen& seen = seen_[static_cast<std::size_t>(index)];
  return seen.place == place ? &seen : nullptr;
}

/// In the place and in the eight around it, or in more.
template <typename Ask>
void ObstacleMemory::ask_beside(Place middle, const Ask& ask, int reach) const {
  for (int row = middle.row - reach; row <= middle.row + reach; ++row)
    for (int column = middle.column - reach; column <= middle.column + reach; ++column)
      if (const Seen* const seen = at({column, row}); seen != nullptr) ask(*seen);
}

template <typename Holds>
bool ObstacleMemory::any_beside(const Vec2& point_m, const Holds& holds) const {
  bool any = false;
  ask_beside(place_of(point_m), [&](const Seen& seen) { any = any || holds(seen); });
  return any;
}

void ObstacleMemory::add(const DeskewedScan& scan) {
  if (scan.rays.empty()) return;
  const Place middle = place_of(scan.rays.back().origin_m);
  forget(scan.newest, middle);
  for (Seen& seen : seen_) seen.hit_now = false;
  mark_hits(scan, middle);
  RayFan fan(scan);
  mark_legs(scan, fan);
  note_hits_beside(scan.newest);
  count_free(scan, fan);
  remember_look(scan, std::move(fan));
  forget(scan.newest, middle);
}

void ObstacleMemory::mark_hits(const DeskewedScan& scan, const Place& middle) {
  const std::vector<Vec2> surface_m = smoothed_ends_m(scan);
  for (std::size_t i = 0; i < scan.rays.size(); ++i) {
    const Ray& ray = scan.rays[i];
    const double from_middle_m = (ray.end_m - center_m(middle)).lpNorm<Eigen::Infinity>();
    if (ends_at_something(ray) && from_middle_m <= options_.half_extent_m) hit(ray, surface_m[i]);
  }
}

void ObstacleMemory::hit(const Ray& ray, const Vec2& surface_m) {
  constexpr int most_hits = 16;  // in the mean: what moves on within the cell is followed
  const Place place = place_of(ray.end_m);
  const Stamp stamp = ray.stamp;
  std::int32_t& index = index_[wrapped(place.column, place.row)];
  if (index < 0) {
    index = static_cast<std::int32_t>(seen_.size());
    seen_.push_back(
        {.place = place, .first_hit = stamp, .last_hit = stamp, .hit_beside = stamp, .judged_at = stamp});
  }
  Seen& seen = seen_[static_cast<std::size_t>(index)];
  if (!has_stood(seen) && is_broken_off(seen, stamp)) {
    seen.first_hit = stamp;
    seen.hits = 0;
    seen.came_at.reset();
    seen.has_come = false;
  }
  if (seen.hits == 0 && was_seen_free(place, stamp)) seen.came_at = stamp;
  if (!seen.came_at && !has_stood(seen)) seen.came_at = came_beside_at(place, stamp);
  seen.hits = std::min(seen.hits + 1, most_hits);
  seen.mean_m += (ray.end_m - seen.mean_m) / seen.hits;
  seen.surface_m += (surface_m - seen.surface_m) / seen.hits;
  seen.last_hit = std::max(seen.last_hit, stamp);
  const double to_come = std::max<double>(options_.hits_to_come, options_.hits_to_come_m / range_m(ray));
  seen.has_come = seen.has_come || (seen.came_at && seen.hits >= std::min<double>(to_come, most_hits));
  if (range_m(ray) <= LegOptions{}.within_m) seen.judged_at = stamp;
  seen.times_free = 0;
  seen.hit_now = true;
}

/// Was it missed for too long to be still the same that was hit before?
bool ObstacleMemory::is_broken_off(const Seen& seen, Stamp now) const {
  if (!is_leg(seen)) return now - seen.last_hit > options_.longest_unseen;
  return now - seen.last_hit > options_.longest_unseen_leg || now - seen.hit_beside > options_.longest_unseen;
}

void ObstacleMemory::note_hits_beside(Stamp now) {
  for (Seen& seen : seen_) {
    ask_beside(seen.place, [&](const Seen& beside) {
      if (beside.hit_now) seen.hit_beside = now;
    });
  }
}

/// What has come is someone if it can be: only what was always there may be a heap of things.
void ObstacleMemory::mark_legs(const DeskewedScan& scan, const RayFan& fan) {
  const auto mark = [&](const Ray& ray) {
    const Place place = place_of(ray.end_m);
    const std::int32_t index = index_[wrapped(place.column, place.row)];
    if (index < 0) return;
    Seen& seen = seen_[static_cast<std::size_t>(index)];
    seen.leg_at = ray.stamp;
    seen.is_post = false;
  };
  const RaysAtLegs legs = rays_at_legs(scan);
  const std::vector<LonePost> posts = posts_.add(scan, fan, legs.likely);
  for (const LonePost& post : posts) take_as_post(post);
  for (const std::size_t i : legs.likely) {
    const Ray& ray = scan.rays[i];
    if (!has_come(ray.end_m) &&
        std::ranges::any_of(posts, [&](const LonePost& post) { return is_part_of(ray.end_m, post); }))
      continue;
    const bool is_near = range_m(ray) < options_.becomes_leg_from_m;
    if (!is_near || !is_part_of_a_thing(place_of(ray.end_m))) mark(ray);
  }
  for (const std::size_t i : legs.possible)
    if (has_come(scan.rays[i].end_m)) mark(scan.rays[i]);
}

/// Not who has come: it can be someone on one leg, and a post does not come.
void ObstacleMemory::take_as_post(const LonePost& post) {
  for (Seen& seen : seen_) {
    if (!is_part_of(seen.mean_m, post) || has_come(seen.mean_m)) continue;
    seen.leg_at.reset();
    seen.is_post = true;
  }
}

/// What is hit in the same scan is not free, however many rays pass beside it: a leg is thinner than a cell.
/// Nor are the cells beside that it is hit in now and then, nor is a wall that the rays graze.
void ObstacleMemory::count_free(const DeskewedScan& scan, const RayFan& fan) {
  for (Seen& seen : seen_) {
    if (seen.hit_now || (is_leg(seen) && seen.hit_beside == scan.newest)) continue;
    if (fan.passes(center_m(seen.place), 0.5 * options_.cell_m, options_.kept_before_end_m) &&
        !fan.graze(seen.mean_m, options_.cell_m, options_.kept_before_end_m))
      ++seen.times_free;
  }
}

/// A scanner that was blind does not know who came meanwhile: then what it saw before counts as just before.
void ObstacleMemory::remember_look(const DeskewedScan& scan, RayFan fan) {
  const auto lost = std::ranges::count(scan.rays, Echo::invalid, &Ray::echo);
  if (2 * static_cast<std::size_t>(lost) > scan.rays.size()) return;
  if (last_look_) seeing_ += std::min(scan.newest - *last_look_, options_.longest_unseen);
  last_look_ = scan.newest;
  if (looks_.empty() || scan.newest - looks_.back().stamp >= options_.between_looks_back)
    looks_.push_back({scan.newest, seeing_, scan.rays.back().origin_m, std::move(fan)});
  while (seeing_ - looks_.front().seeing > options_.just_before) looks_.pop_front();
}

/// Each part of the place in so many looks, between which nothing was hit there: of a scanner that loses some
/// beams, others in each turn, hardly a look passes all of it.
bool ObstacleMemory::was_seen_free(Place place, Stamp before) const {
  const Vec2 place_m = center_m(place);
  std::array<int, RayFan::parts_across> times_passed{};
  for (const Look& look : looks_) {
    const double away_m = (place_m - look.from_m).norm();
    const double beside_m = options_.seen_free_beside_m + options_.seen_free_beside_per_m * away_m;
    const std::optional<RayFan::PassedParts> passed =
        look.stamp < before && away_m <= options_.seen_free_within_m
            ? look.fan.passed_across(place_m, beside_m, beside_m, options_.seen_free_between_m)
            : std::nullopt;
    if (!passed) {
      times_passed.fill(0);
      continue;
    }
    for (std::size_t part = 0; part < times_passed.size(); ++part)
      times_passed[part] += passed->test(part) ? 1 : 0;
    const int wanted = away_m <= options_.seen_free_near_m ? options_.looks_free : options_.looks_free_far;
    if (std::ranges::min(times_passed) >= wanted) return true;
  }
  return false;
}

void ObstacleMemory::forget(Stamp now, const Place& middle) {
  for (std::size_t i = 0; i < seen_.size();) {
    const Seen& seen = seen_[i];
    const bool is_here = std::abs(seen.place.column - middle.column) <= half_cells_ &&
                         std::abs(seen.place.row - middle.row) <= half_cells_;
    if (is_here && seen.times_free < options_.scans_to_clear && is_remembered(seen, now)) {
      ++i;
      continue;
    }
    index_[wrapped(seen.place.column, seen.place.row)] = -1;
    if (i + 1 < seen_.size()) {
      const Place moved = seen_.back().place;
      index_[wrapped(moved.column, moved.row)] = static_cast<std::int32_t>(i);
      seen_[i] = seen_.back();
    }
    seen_.pop_back();
  }
}

bool ObstacleMemory::is_leg(const Seen& seen) const {
  return seen.leg_at && seen.judged_at - *seen.leg_at < options_.not_a_leg_after;
}

bool ObstacleMemory::has_stood(const Seen& seen) const {
  const Duration hit_for = seen.last_hit - seen.first_hit;
  if (is_leg(seen)) return hit_for >= options_.to_stand_as_a_person;
  return hit_for >= options_.to_stand &&
         (!seen.came_at || seen.last_hit - *seen.came_at >= options_.to_stand_as_a_person);
}

bool ObstacleMemory::came_lately(const Seen& seen) const {
  return seen.has_come && seen.last_hit - *seen.came_at < options_.to_stay;
}

bool ObstacleMemory::is_remembered(const Seen& seen, Stamp now) const {
  return now - seen.last_hit <= (has_stood(seen) ? options_.remembered_standing : options_.remembered_moving);
}

/// Who stands and sways a little, or is pushed along, has come when the cells beside did.
std::optional<Stamp> ObstacleMemory::came_beside_at(Place place, Stamp now) const {
  std::optional<Stamp> latest;
  ask_beside(place, [&](const Seen& seen) {
    if (seen.has_come && is_remembered(seen, now))
      latest = std::max(latest.value_or(*seen.came_at), *seen.came_at);
  });
  return latest;
}

bool ObstacleMemory::stands_at(const Vec2& point_m, Stamp now) const {
  return any_beside(point_m, [&](const Seen& seen) { return has_stood(seen) && is_remembered(seen, now); });
}

/// What is hit in a cell for the first time may have come there as long ago as the floor was last seen free.
bool ObstacleMemory::has_come_to(const Vec2& point_m) const {
  const Seen* const seen = at(place_of(point_m));
  return seen != nullptr && seen->came_at &&
         seen->last_hit - *seen->came_at < options_.to_stand_as_a_person - options_.just_before;
}

/// Has something stood here for so long that is no leg, and has not come? The noise of the range reaches over
/// two cells.
bool ObstacleMemory::is_part_of_a_thing(Place place) const {
  bool has_thing = false;
  bool may_be_someone = false;
  const auto ask = [&](const Seen& seen) {
    may_be_someone = may_be_someone || is_leg(seen) || seen.has_come;
    has_thing = has_thing || has_stood(seen);
  };
  ask_beside(place, ask, 2);
  return has_thing && !may_be_someone;
}

bool ObstacleMemory::has_legs(const Vec2& point_m) const {
  return any_beside(point_m, [&](const Seen& seen) { return is_leg(seen); });
}

bool ObstacleMemory::has_come(const Vec2& point_m) const {
  return any_beside(point_m, [](const Seen& seen) { return seen.has_come; });
}

bool ObstacleMemory::may_go(const Vec2& point_m) const {
  return has_come(point_m) &&
         any_beside(point_m, [&](const Seen& seen) { return is_leg(seen) || came_lately(seen); });
}

std::vector<Vec2> ObstacleMemory::standing_m(Stamp now) const {
  std::vector<Vec2> points_m;
  for (const Seen& seen : seen_)
    if (has_stood(seen) && is_remembered(seen, now)) points_m.push_back(seen.surface_m);
  return points_m;
}

std::vector<Vec2> ObstacleMemory::standing_people_m(Stamp now) const {
  std::vector<Vec2> points_m;
  for (const Seen& seen : seen_)
    if ((is_leg(seen) || came_lately(seen)) && has_stood(seen) && is_remembered(seen, now))
      points_m.push_back(seen.surface_m);
  return points_m;
}

std::vector<Vec2> ObstacleMemory::standing_posts_m(Stamp now) const {
  std::vector<Vec2> points_m;
  for (const Seen& seen : seen_)
    if (seen.is_post && has_stood(seen) && is_remembered(seen, now)) points_m.push_back(seen.surface_m);
  return points_m;
}

std::vector<Vec2> ObstacleMemory::occupied_m(Stamp now) const {
  std::vector<Vec2> points_m;
  for (const Seen& seen : seen_)
    if (is_remembered(seen, now)) points_m.push_back(center_m(seen.place));
  return points_m;
}

}  // namespace lodestar
