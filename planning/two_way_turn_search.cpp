#include "planning/two_way_turn_search.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

/// The cost to the goal is that of an actual path, which another turn into it may improve by about this much.
constexpr double improvement_s = 1.5;
constexpr std::size_t units_to_look = 10;

}  // namespace

/// Least total first; ties by place and origin, so that the search is deterministic.
struct TwoWayTurnSearch::Later {
  bool operator()(const Open& a, const Open& b) const {
    if (a.total != b.total) return a.total > b.total;
    return a.place != b.place ? a.place > b.place : a.from > b.from;
  }
};

TwoWayTurnSearch::TwoWayTurnSearch(const CollisionChecker& space, std::span<const TurnPoint> turn_points,
                                   const TurnSearchLimits& limits)
    : space_(space), limits_(limits), choice_(space, turn_points) {}

TurnPath TwoWayTurnSearch::find(std::span<const Vec2> known, const EndHeadings& headings,
                                const PathCost& cost, int round) {
  cost_ = &cost;
  headings_ = headings;
  const double known_cost = cost.path(known, headings);
  limit_ = known_cost * (1.0 - negligible_saving);
  work_ = 0;
  expanded_ = 0;
  complete_.clear();
  gather_places(known, round);
  search_backwards();
  search_forwards();
  TurnPath found = best_paths();
  if (found.points.empty()) {
    found.points.assign(known.begin(), known.end());
    found.cost = known_cost;
  }
  found.expanded = expanded_;
  found.work = work_;
  return found;
}

/// The cheapest path, and the next one that turns at clearly different places; more of them cost time and
/// save hardly any.
TurnPath TwoWayTurnSearch::best_paths() {
  std::ranges::sort(complete_, [](const Open& a, const Open& b) { return Later{}(b, a); });
  TurnPath found;
  const double apart = 4.0 * space_.radius_cells();
  const auto is_near = [&](const Vec2& p, const Vec2& q) { return (p - q).norm() < apart; };
  for (const Open& each : complete_) {
    std::vector<Vec2> points = points_over(each.from);
    if (found.points.empty()) {
      found.points = std::move(points);
      found.cost = each.total;
    } else if (!std::ranges::equal(points, found.points, is_near)) {
      found.others.push_back(std::move(points));
      break;
    }
  }
  return found;
}

void TwoWayTurnSearch::gather_places(std::span<const Vec2> known, int round) {
  const std::vector<TurnPlace>& chosen =
      choice_.choose(known, cost_->longest(limit_), cost_->counts_turns(), limits_.candidates, round);
  places_.clear();
  screen_.clear();
  add_place({known.back(), std::nullopt});
  add_place({known.front(), std::nullopt});
  for (const Vec2& point : known.subspan(1, known.size() - 2)) add_place({point, std::nullopt});
  for (const TurnPlace& place : chosen) add_place(place);
  sights_.assign(places_.size() * places_.size(), Sight::unknown);
}

void TwoWayTurnSearch::add_place(const TurnPlace& at) {
  const Vec2& position = at.position;
  Place place{.position = position, .corner = at.corner};
  place.to_start_cells = choice_.to_start_cells(position);
  place.to_goal_cells = choice_.to_goal_cells(position);
  const auto least = [&](std::uint32_t end, double over_tiles) {
    if (places_.size() <= end) return 0.0;
    const double straight = (position - places_[end].position).norm();
    return cost_->at_least(std::max(straight, choice_.at_least_cells(over_tiles)));
  };
  place.least_to_goal = least(goal, place.to_goal_cells);
  place.least_from_start = least(start, place.to_start_cells);
  if (places_.size() > start && place.least_from_start + place.least_to_goal >= limit_) return;
  places_.push_back(place);
  screen_.add(position, cost_->longest(place.least_from_start));
}

/// False when the paths over tiles differ by more than a straight leg between the two can.
bool TwoWayTurnSearch::may_see(const Place& from, const Place& to, double length_cells) const {
  const double most = choice_.at_most_cells(length_cells);
  return std::abs(from.to_start_cells - to.to_start_cells) <= most &&
         std::abs(from.to_goal_cells - to.to_goal_cells) <= most;
}

/// False for a turn away from the place's corner: such a path could be cut short.
bool TwoWayTurnSearch::is_taut(const Place& at, const Vec2& from, const Vec2& to) const {
  if (!at.corner) return true;
  const Vec2 arrival = at.position - from;
  const Vec2 way = to - at.position;
  const Vec2 to_corner = *at.corner - at.position;
  const double turn = cross(arrival, way);
  return turn * cross(arrival, to_corner) >= 0.0 && turn * cross(way, to_corner) >= 0.0;
}

/// A quick look, once for each line of sight.
bool TwoWayTurnSearch::may_be_clear(std::uint32_t from, std::uint32_t to) {
  work_ += units_to_look;
  Sight& sight = sight_between(from, to);
  if (sight == Sight::unknown)
    sight = space_.is_surely_blocked(places_[from].position, places_[to].position) ? Sight::blocked
                                                                                   : Sight::perhaps;
  return sight != Sight::blocked;
}

/// Each line of sight is checked once.
bool TwoWayTurnSearch::sees(std::uint32_t from, std::uint32_t to) {
  Sight& sight = sight_between(from, to);
  if (sight == Sight::unknown || sight == Sight::perhaps) {
    const Vec2& begin = places_[from].position;
    const Vec2& end = places_[to].position;
    work_ += work_of_check((end - begin).norm());
    sight = space_.along(begin, end) ? Sight::clear : Sight::blocked;
  }
  return sight == Sight::clear;
}

/// What a clear leg costs above its least cost; nothing when it is blocked.
std::optional<double> TwoWayTurnSearch::extra_cost(std::uint32_t from, std::uint32_t to) {
  if (!sees(from, to)) return std::nullopt;
  if (!cost_->counts_cells()) return 0.0;
  const Vec2& begin = places_[from].position;
  const Vec2& end = places_[to].position;
  const double length_cells = (end - begin).norm();
  work_ += static_cast<std::size_t>(length_cells);
  return cost_->leg(begin, end) - cost_->at_least(length_cells);
}

/// Looks at a label's leg, once. False where it is blocked; and where it costs more than its least cost: then
/// the label waits again at its true cost.
bool TwoWayTurnSearch::is_settled(Open& label, std::uint32_t from, std::uint32_t to) {
  if (label.looked_at) return true;
  const std::optional<double> extra = extra_cost(from, to);
  if (!extra) return false;
  label.looked_at = true;
  label.cost += *extra;
  label.total += *extra;
  if (*extra > 0.0) {
    push(label);
    return false;
  }
  return true;
}

void TwoWayTurnSearch::push(const Open& open) {
  open_.push_back(open);
  std::ranges::push_heap(open_, Later{});
}

TwoWayTurnSearch::Open TwoWayTurnSearch::pop() {
  const Open open = open_.front();
  std::ranges::pop_heap(open_, Later{});
  open_.pop_back();
  return open;
}

/// Nine tenths of the work at most.
void TwoWayTurnSearch::search_backwards() {
  open_.clear();
  places_[goal].next = goal;
  screen_.remove(goal);
  expand_backwards(goal);
  while (!open_.empty() && work_ < limits_.work / 10 * 9) {
    Open next = pop();
    Place& place = places_[next.place];
    if (place.next != none) continue;
    if (!is_settled(next, next.place, next.from)) continue;
    place.next = next.from;
    screen_.remove(next.place);
    place.cost_to_goal = next.cost;
    place.heading_on_rad = next.heading_rad;
    if (next.place != start) expand_backwards(next.place);
  }
}

/// Cheap tests come first, since most legs fail one of them; a heading costs more than a look at the leg.
void TwoWayTurnSearch::expand_backwards(std::uint32_t place) {
  const Place& to = places_[place];
  work_ += places_.size();
  ++expanded_;
  const double longest_cells = cost_->longest(limit_ - to.cost_to_goal);
  for (const std::uint32_t other : screen_.may_lead_to(to.position, turn_around(place), longest_cells)) {
    const Place& from = places_[other];
    if (place != goal && !is_taut(to, from.position, places_[to.next].position)) continue;
    const Vec2 way = to.position - from.position;
    const double length_cells = way.norm();
    if (length_cells == 0.0) continue;
    Open open{.cost = to.cost_to_goal + cost_->at_least(length_cells), .place = other, .from = place};
    if (open.cost + from.least_from_start >= limit_ || !may_see(from, to, length_cells)) continue;
    if (!may_be_clear(other, place)) continue;
    if (cost_->counts_turns()) {
      open.heading_rad = heading_of(way);
      open.cost += turn_at(place, open.heading_rad);
      if (open.cost + from.least_from_start >= limit_) continue;
    }
    open.total = open.cost;
    push(open);
  }
}

/// Around the place's corner into its cheapest way on.
std::optional<TurnAround> TwoWayTurnSearch::turn_around(std::uint32_t place) const {
  const Place& at = places_[place];
  if (place == goal || !at.corner) return std::nullopt;
  return TurnAround{.way = places_[at.next].position - at.position, .to_corner = *at.corner - at.position};
}

/// Cost of the turn from an arrival into the cheapest path on to the goal.
double TwoWayTurnSearch::turn_at(std::uint32_t place, double arrival_rad) const {
  if (place != goal) return cost_->turn(arrival_rad, places_[place].heading_on_rad);
  return headings_.goal_rad ? cost_->turn(arrival_rad, *headings_.goal_rad) : 0.0;
}

void TwoWayTurnSearch::search_forwards() {
  open_.clear();
  labels_.clear();
  labels_.push_back({.heading_rad = headings_.start_rad.value_or(0.0), .place = start});
  expand_forwards(0);
  const double slack = cost_->counts_turns() ? improvement_s : 0.0;
  while (!open_.empty() && work_ < limits_.work) {
    Open next = pop();
    if (next.total >= limit_ + slack) break;
    if (is_dominated(next)) continue;
    if (!is_settled(next, labels_[next.from].place, next.place)) continue;
    const auto label = static_cast<std::uint32_t>(labels_.size());
    Place& at = places_[next.place];
    labels_.push_back({next.cost, next.heading_rad, next.place, next.from, at.newest_label});
    at.newest_label = label;
    limit_ = std::min(limit_, next.total);
    complete_.push_back({.total = next.total, .place = next.place, .from = label});
    if (next.place != goal) expand_forwards(label);
  }
}

void TwoWayTurnSearch::expand_forwards(std::uint32_t label) {
  const Label from = labels_[label];
  const Place& at = places_[from.place];
  work_ += places_.size();
  ++expanded_;
  const bool counts_turns = cost_->counts_turns();
  const double limit = limit_ + (counts_turns ? improvement_s : 0.0);
  for (std::uint32_t other = 0; other < places_.size(); ++other) {
    const Place& to = places_[other];
    if (to.next == none || other == start || other == from.place) continue;
    if (from.place != start && !is_taut(at, places_[labels_[from.parent].place].position, to.position))
      continue;
    const Vec2 way = to.position - at.position;
    const double length_cells = way.norm();
    if (length_cells == 0.0) continue;
    Open open{.cost = from.cost + cost_->at_least(length_cells), .place = other, .from = label};
    if (open.cost + to.cost_to_goal >= limit || !may_see(at, to, length_cells)) continue;
    if (!may_be_clear(from.place, other)) continue;
    if (counts_turns) open.heading_rad = heading_of(way);
    if (counts_turns && (from.place != start || headings_.start_rad))
      open.cost += cost_->turn(from.heading_rad, open.heading_rad);
    open.total = open.cost + to.cost_to_goal + (counts_turns ? turn_at(other, open.heading_rad) : 0.0);
    if (open.total < limit && !is_dominated(open)) push(open);
  }
}

/// Is another label of the same place, plus a turn on the spot, as cheap within the slack?
bool TwoWayTurnSearch::is_dominated(const Open& open) const {
  const double slack = cost_->counts_turns() && open.place != goal ? as_good_s : 0.0;
  for (std::uint32_t i = places_[open.place].newest_label; i != none; i = labels_[i].older_label) {
    if (labels_[i].cost + cost_->turn(labels_[i].heading_rad, open.heading_rad) <= open.cost + slack)
      return true;
  }
  return false;
}

/// The way to a label and its place's cheapest path on.
std::vector<Vec2> TwoWayTurnSearch::points_over(std::uint32_t label) const {
  std::vector<Vec2> points;
  for (std::uint32_t i = label; i != none; i = labels_[i].parent)
    points.push_back(places_[labels_[i].place].position);
  std::ranges::reverse(points);
  for (std::uint32_t place = labels_[label].place; place != goal;) {
    place = places_[place].next;
    points.push_back(places_[place].position);
  }
  return points;
}

}  // namespace lodestar
