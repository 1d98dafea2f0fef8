#include "drivers/simulation/contact_judge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "maps/ray_casting.hpp"

namespace lodestar {
namespace {

constexpr double moving_mps = 0.01;
/// What has been in sight for longer than this excuses nothing.
constexpr Duration longest_memory = std::chrono::seconds(5);
/// Over so many records the speed is measured: slip makes single steps uneven.
constexpr std::size_t speed_records = 2;

}  // namespace

ContactJudge::ContactJudge(const OccupancyMap& map, double robot_radius_m,
                           const std::optional<Footprint>& footprint, const ContactJudgeOptions& options)
    : map_(map),
      robot_radius_m_(robot_radius_m),
      footprint_(footprint),
      clearance_(map, robot_radius_m, footprint),
      options_(options) {}

void ContactJudge::change_map(const OccupancyMap& map) {
  map_ = map;
  clearance_ = RobotClearance(map, robot_radius_m_, footprint_);
  room_on_map_m_ = 0.0;
}

void ContactJudge::record(Stamp now, const Pose2& map_from_base, std::span<const DiscState> discs) {
  remember(now, map_from_base, discs);
  measure_room(discs);
  touches_.resize(discs.size(), Touch::none);
  for (std::size_t i = 0; i < discs.size(); ++i) judge(i, discs[i]);
}

/// A kidnapping is no driving: nothing with wheels is that fast.
bool ContactJudge::is_carried_off(Stamp now, const Pose2& map_from_base) const {
  constexpr double carried_mps = 10.0;
  if (history_.empty()) return false;
  const double moved_m = (map_from_base.position_m - history_.back().map_from_base.position_m).norm();
  return moved_m > carried_mps * seconds(now - history_.back().stamp);
}

void ContactJudge::remember(Stamp now, const Pose2& map_from_base, std::span<const DiscState> discs) {
  if (is_carried_off(now, map_from_base)) {  // as if it began here
    history_.clear();
    has_forgotten_ = false;
    room_on_map_m_ = 0.0;
  }
  Moment moment;
  if (!history_.empty() && now - history_.front().stamp > longest_memory) {
    moment = std::move(history_.front());  // for its memory
    history_.pop_front();
    has_forgotten_ = true;
  }
  moment.stamp = now;
  moment.map_from_base = map_from_base;
  moment.speed_mps = 0.0;
  moment.discs.assign(discs.begin(), discs.end());
  if (!history_.empty()) {
    const Moment& before = history_[history_.size() - std::min(speed_records, history_.size())];
    const double elapsed_s = seconds(now - before.stamp);
    const double moved_m = (map_from_base.position_m - before.map_from_base.position_m).norm();
    const double turned_rad = std::abs(wrap_angle(map_from_base.yaw_rad - before.map_from_base.yaw_rad));
    moment.speed_mps = std::max(moved_m, turned_rad * clearance_.outer_radius_m()) / elapsed_s;
    const Pose2& last = history_.back().map_from_base;
    room_on_map_m_ -=
        (map_from_base.position_m - last.position_m).norm() +
        std::abs(wrap_angle(map_from_base.yaw_rad - last.yaw_rad)) * clearance_.outer_radius_m();
  }
  history_.push_back(std::move(moment));
}

void ContactJudge::measure_room(std::span<const DiscState> discs) {
  constexpr double beyond_m = 1e4;   // any site
  constexpr double further_m = 1.0;  // than needed, so that what was measured holds for some way
  const Pose2& map_from_base = history_.back().map_from_base;
  double least_m = score_.least_clearance_m.value_or(beyond_m);
  for (const DiscState& disc : discs)
    least_m = std::min(least_m, clearance_.to_disc_m(map_from_base, disc.position_m, disc.radius_m));
  if (room_on_map_m_ < least_m) {  // otherwise nothing on the map can be as near
    const double most_m = least_m + further_m;
    room_on_map_m_ = clearance_.to_map_m(map_from_base, most_m).value_or(most_m);
    least_m = std::min(least_m, room_on_map_m_);
  }
  if (least_m < beyond_m) score_.least_clearance_m = least_m;
}

void ContactJudge::judge(std::size_t disc, const DiscState& state) {
  const Moment& now = history_.back();
  Touch& touch = touches_[disc];
  if (clearance_.to_disc_m(now.map_from_base, state.position_m, state.radius_m) >= 0.0) {
    touch = Touch::none;
    return;
  }
  const bool moves = now.speed_mps > moving_mps;
  if (moves) score_.greatest_contact_mps = std::max(score_.greatest_contact_mps, now.speed_mps);
  if (!moves && touch == Touch::none) {
    touch = Touch::at_rest;
    ++score_.at_rest;
  }
  if (!moves || touch == Touch::moving) return;
  // One contact is one event: a robot that moves off while it is touched has not stood.
  if (touch == Touch::at_rest && score_.at_rest > 0) --score_.at_rest;
  touch = Touch::moving;
  ++(is_excused(disc) ? score_.excused : score_.moving);
}

bool ContactJudge::is_excused(std::size_t disc) const {
  return was_fast(disc) || came_into_sight_too_late(disc);
}

bool ContactJudge::was_fast(std::size_t disc) const {
  constexpr double rounding = 1e-6;
  const Stamp since = history_.back().stamp - options_.fast_within;
  for (std::size_t i = history_.size() - 1; i > 0 && history_[i].stamp > since; --i) {
    const double moved_m =
        (history_[i].discs[disc].position_m - history_[i - 1].discs[disc].position_m).norm();
    const double elapsed_s = seconds(history_[i].stamp - history_[i - 1].stamp);
    if (moved_m > options_.fast_mps * elapsed_s * (1.0 + rounding)) return true;
  }
  return false;
}

/// Walks back to when it came into sight; having been hidden for less than a scan counts as in sight.
bool ContactJudge::came_into_sight_too_late(std::size_t disc) const {
  const Moment& contact = history_.back();
  std::optional<std::size_t> first_seen;
  Stamp last_seen = contact.stamp;
  std::size_t i = history_.size();
  std::vector<VisibleDisc> visible;
  while (i > 0 && last_seen - history_[i - 1].stamp <= options_.scan_period) {
    --i;
    visible.clear();
    append_visible(history_[i].discs[disc], visible);
    if (std::ranges::none_of(visible, [&](const VisibleDisc& part) { return sees(history_[i], part); }))
      continue;
    first_seen = i;
    last_seen = history_[i].stamp;
  }
  const bool was_seen_always = i == 0 && has_forgotten_;
  if (was_seen_always) return false;
  if (!first_seen) return true;
  const Moment& sighting = history_[*first_seen];
  const double needed_s = seconds(options_.scan_period + options_.scan_delay + options_.reaction) +
                          sighting.speed_mps / options_.protective_deceleration_mps2;
  return seconds(contact.stamp - sighting.stamp) < needed_s;
}

/// Any of five points across the near side of the disc.
bool ContactJudge::sees(const Moment& moment, const VisibleDisc& disc) const {
  const Vec2 scanner_m = (moment.map_from_base * options_.base_from_scanner).position_m;
  const Vec2 way = disc.center_m - scanner_m;
  const double distance_m = way.norm();
  if (distance_m <= disc.radius_m) return true;
  if (distance_m - disc.radius_m > options_.range_m) return false;
  const Vec2 ahead = way / distance_m;
  const Vec2 left(-ahead.y(), ahead.x());
  constexpr std::array shares{0.0, -0.5, 0.5, -0.9, 0.9};
  return std::ranges::any_of(shares, [&](double share) {
    const Vec2 point_m =
        disc.center_m + disc.radius_m * (share * left - std::sqrt(1.0 - square(share)) * ahead);
    return is_in_sight(map_, scanner_m, point_m);
  });
}

}  // namespace lodestar
