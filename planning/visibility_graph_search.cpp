#include "planning/visibility_graph_search.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

constexpr double negligible = 1e-9;  ///< relative saving of cost that is not worth another path
/// Dominance slack in seconds: a label is dropped when another one plus the turn between their headings is at
/// most this much slower.
constexpr double as_good_s = 0.3;
/// Inflation of the heuristic (weighted A*) when turns count, as the heuristic ignores obstacles.
constexpr double stretch = 0.2;
constexpr std::uint32_t goal_candidate = 0;

}  // namespace

/// Least total first; ties by candidate and parent, so that the search is deterministic.
struct VisibilityGraphSearch::Later {
  bool operator()(const Open& a, const Open& b) const {
    if (a.total != b.total) return a.total > b.total;
    return a.candidate != b.candidate ? a.candidate > b.candidate : a.parent > b.parent;
  }
};

VisibilityGraphSearch::VisibilityGraphSearch(const CollisionChecker& space,
                                             std::vector<TurnPoint> turn_points)
    : space_(space), turn_points_(std::move(turn_points)) {
  constexpr std::size_t most_remembered = 4000;  // 16 MB of cached sights
  if (turn_points_.size() <= most_remembered) sights_.resize(turn_points_.size() * turn_points_.size());
}

TurnPath VisibilityGraphSearch::find(std::span<const Vec2> known, const EndHeadings& headings,
                                     const PathCost& cost) {
  cost_ = &cost;
  headings_ = headings;
  start_ = known.front();
  goal_ = known.back();
  const double known_cost = cost.path(known, headings);
  limit_ = known_cost * (1.0 - negligible);
  labels_.clear();
  open_.clear();
  gather_candidates(known);

  labels_.push_back({.heading_rad = headings.start_rad.value_or(0.0), .candidate = none});
  expand(0);
  std::size_t expanded = 1;
  while (!open_.empty()) {
    Open next = open_.front();
    std::ranges::pop_heap(open_, Later{});
    open_.pop_back();
    if (is_dominated(next) || !goes_on(next)) continue;
    const auto label = static_cast<std::uint32_t>(labels_.size());
    Candidate& at = candidates_[next.candidate];
    labels_.push_back({next.cost, next.heading_rad, next.candidate, next.parent, at.newest_label});
    at.newest_label = label;
    if (next.candidate == goal_candidate) return {points_to(label), next.total, expanded};
    expand(label);
    ++expanded;
  }
  return {{known.begin(), known.end()}, known_cost, expanded};
}

void VisibilityGraphSearch::gather_candidates(std::span<const Vec2> known) {
  candidates_.clear();
  add_candidate(goal_, none);
  for (const Vec2& point : known.subspan(1, known.size() - 2)) add_candidate(point, none);
  for (std::uint32_t i = 0; i < turn_points_.size(); ++i) {
    if (turn_points_[i].tight || cost_->counts_turns()) add_candidate(turn_points_[i].position, i);
  }
}

/// Skips a point when even the straight path through it reaches the upper bound.
void VisibilityGraphSearch::add_candidate(const Vec2& position, std::uint32_t turn_point) {
  const Vec2 from_start = position - start_;
  const Vec2 to_goal = goal_ - position;
  const double least_to_goal = cost_->at_least(to_goal.norm());
  const double least = cost_->at_least(from_start.norm()) + least_to_goal;
  const bool is_goal = candidates_.empty();
  if (!is_goal && least >= limit_) return;
  Candidate candidate{.position = position, .least_to_goal = least_to_goal, .turn_point = turn_point};
  if (turn_point != none) candidate.corner = turn_points_[turn_point].corner;
  if (cost_->counts_turns() && !is_goal) {
    candidate.heading_to_goal_rad = heading_of(to_goal);
    // Whatever lies between, the turns add up to at least that between these two headings.
    const double turn = cost_->turn(heading_of(from_start), candidate.heading_to_goal_rad);
    if (least + turn >= limit_) return;
  }
  candidates_.push_back(candidate);
}

void VisibilityGraphSearch::expand(std::uint32_t label) {
  const Label& from = labels_[label];
  from_ = {.position = position_of(from)};
  if (from.candidate != none) {
    const Candidate& at = candidates_[from.candidate];
    from_.turn_point = at.turn_point;
    from_.arrival = from_.position - position_of(labels_[from.parent]);
    from_.to_corner = at.corner - at.position;
    from_.corner_side = cross(from_.arrival, from_.to_corner);
  }
  for (std::uint32_t i = 0; i < candidates_.size(); ++i) {
    if (i != labels_[label].candidate) consider(label, i);
  }
}

void VisibilityGraphSearch::consider(std::uint32_t label, std::uint32_t candidate) {
  const Label& from = labels_[label];
  const Candidate& to = candidates_[candidate];
  const bool at_start = from.candidate == none;
  const Vec2 way = to.position - from_.position;
  if (!turns_around_its_corner(way) || known_sight(from_.turn_point, to.turn_point) == Sight::blocked) return;
  const double cost = from.cost + cost_->at_least(way.norm());
  if (cost + to.least_to_goal >= limit_ || way.isZero(0.0)) return;
  Open open{.total = cost + to.least_to_goal, .cost = cost, .candidate = candidate, .parent = label};
  if (cost_->counts_turns()) {
    open.heading_rad = heading_of(way);
    if (!at_start || headings_.start_rad) open.cost += cost_->turn(from.heading_rad, open.heading_rad);
    open.total = open.cost + least_rest(to, open.heading_rad);
    if (open.total >= limit_) return;
    open.total += stretch * (open.total - open.cost);
  }
  if (!is_dominated(open)) push(open);
}

void VisibilityGraphSearch::push(const Open& open) {
  open_.push_back(open);
  std::ranges::push_heap(open_, Later{});
}

/// False for a turn away from the point's corner: such a path could be cut short.
bool VisibilityGraphSearch::turns_around_its_corner(const Vec2& way) const {
  if (from_.turn_point == none) return true;
  const double turn = cross(from_.arrival, way);
  return turn * from_.corner_side >= 0.0 && turn * cross(way, from_.to_corner) >= 0.0;
}

/// Is another label of the same point, plus a turn on the spot, as cheap within the slack?
bool VisibilityGraphSearch::is_dominated(const Open& open) const {
  const double slack = cost_->counts_turns() && open.candidate != goal_candidate ? as_good_s : 0.0;
  for (std::uint32_t i = candidates_[open.candidate].newest_label; i != none; i = labels_[i].older_label) {
    if (labels_[i].cost + cost_->turn(labels_[i].heading_rad, open.heading_rad) <= open.cost + slack)
      return true;
  }
  return false;
}

/// Admissible heuristic: the straight leg to the goal, plus the larger of the turns towards the goal and to
/// the final heading.
double VisibilityGraphSearch::least_rest(const Candidate& candidate, double heading_rad) const {
  const bool is_goal = &candidate == candidates_.data();
  double turn = is_goal ? 0.0 : cost_->turn(heading_rad, candidate.heading_to_goal_rad);
  if (headings_.goal_rad) turn = std::max(turn, cost_->turn(heading_rad, *headings_.goal_rad));
  return candidate.least_to_goal + turn;
}

/// Is the leg clear, at the cost assumed so far? A clear leg that costs more is re-queued at its true cost.
bool VisibilityGraphSearch::goes_on(Open& open) {
  if (open.looked_at) return true;
  const Label& parent = labels_[open.parent];
  const Vec2& from = position_of(parent);
  const Vec2& to = candidates_[open.candidate].position;
  const std::uint32_t from_turn_point =
      parent.candidate == none ? none : candidates_[parent.candidate].turn_point;
  if (!sees(from_turn_point, candidates_[open.candidate].turn_point, from, to)) return false;
  if (!cost_->counts_cells()) return true;
  const double more = cost_->leg(from, to) - cost_->at_least((to - from).norm());
  if (more <= 0.0) return true;
  open.looked_at = true;
  open.cost += more;
  open.total += more;
  if (open.total < limit_) push(open);
  return false;
}

VisibilityGraphSearch::Sight VisibilityGraphSearch::known_sight(std::uint32_t from_turn_point,
                                                                std::uint32_t to_turn_point) const {
  if (from_turn_point == none || to_turn_point == none || sights_.empty()) return Sight::unknown;
  const auto [low, high] = std::minmax(from_turn_point, to_turn_point);
  return sights_[low * turn_points_.size() + high];
}

/// Lines of sight between turn points are cached, as they depend only on the map.
bool VisibilityGraphSearch::sees(std::uint32_t from_turn_point, std::uint32_t to_turn_point, const Vec2& from,
                                 const Vec2& to) {
  if (from_turn_point == none || to_turn_point == none || sights_.empty()) return space_.along(from, to);
  const auto [low, high] = std::minmax(from_turn_point, to_turn_point);
  Sight& sight = sights_[low * turn_points_.size() + high];
  if (sight == Sight::unknown) sight = space_.along(from, to) ? Sight::clear : Sight::blocked;
  return sight == Sight::clear;
}

std::vector<Vec2> VisibilityGraphSearch::points_to(std::uint32_t label) const {
  std::vector<Vec2> points;
  for (; labels_[label].candidate != none; label = labels_[label].parent) {
    points.push_back(position_of(labels_[label]));
  }
  points.push_back(start_);
  std::ranges::reverse(points);
  return points;
}

}  // namespace lodestar
