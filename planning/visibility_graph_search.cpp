#include "planning/visibility_graph_search.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

/// Inflation of the heuristic (weighted A*) when turns count, as the heuristic ignores obstacles.
constexpr double stretch = 0.2;
constexpr std::uint32_t goal_candidate = 0;
constexpr std::size_t more_for_cells = 10;  ///< times the work where cells cost differently

}  // namespace

/// Least total first; ties by candidate and parent, so that the search is deterministic.
struct VisibilityGraphSearch::Later {
  bool operator()(const Open& a, const Open& b) const {
    if (a.total != b.total) return a.total > b.total;
    return a.candidate != b.candidate ? a.candidate > b.candidate : a.parent > b.parent;
  }
};

VisibilityGraphSearch::VisibilityGraphSearch(const CollisionChecker& space,
                                             std::vector<TurnPoint> turn_points,
                                             const TurnSearchLimits& limits)
    : space_(space),
      turn_points_(std::move(turn_points)),
      limits_(limits),
      two_way_(space_, turn_points_, limits_) {}

TurnPath VisibilityGraphSearch::find(std::span<const Vec2> known, const EndHeadings& headings,
                                     const PathCost& cost, int round) {
  cost_ = &cost;
  headings_ = headings;
  start_ = known.front();
  goal_ = known.back();
  limit_ = cost.path(known, headings) * (1.0 - negligible_saving);
  labels_.clear();
  open_.clear();
  work_ = 0;
  // The fastest path often turns on open ground, where only the search both ways has turn points.
  const bool turns_anywhere = cost.counts_turns() && !cost.counts_cells();
  if (turns_anywhere || round > 0 || !gather_candidates(known))
    return two_way_.find(known, headings, cost, round);
  TurnPath found = search(known);
  found.work = work_;
  return found;
}

TurnPath VisibilityGraphSearch::search(std::span<const Vec2> known) {
  labels_.push_back({.heading_rad = headings_.start_rad.value_or(0.0), .candidate = none});
  expand(0);
  std::size_t expanded = 1;
  const std::size_t most_work = (cost_->counts_cells() ? more_for_cells : 1) * limits_.work;
  while (!open_.empty() && work_ < most_work) {
    Open next = open_.front();
    std::ranges::pop_heap(open_, Later{});
    open_.pop_back();
    if (is_dominated(next) || !goes_on(next)) continue;
    const auto label = static_cast<std::uint32_t>(labels_.size());
    Candidate& at = candidates_[next.candidate];
    labels_.push_back({next.cost, next.heading_rad, next.candidate, next.parent, at.newest_label});
    at.newest_label = label;
    if (next.candidate == goal_candidate)
      return {.points = points_to(label),
              .cost = next.cost + least_rest(at, next.heading_rad),
              .expanded = expanded};
    expand(label);
    ++expanded;
  }
  if (std::optional<TurnPath> found = best_waiting()) {
    found->expanded = expanded;
    return *found;
  }
  return {
      .points = {known.begin(), known.end()}, .cost = cost_->path(known, headings_), .expanded = expanded};
}

/// After the work is used up: the best of the paths that wait for a look at their last leg.
std::optional<TurnPath> VisibilityGraphSearch::best_waiting() {
  std::vector<Open> last;
  for (const Open& open : open_)
    if (open.candidate == goal_candidate) last.push_back(open);
  std::ranges::sort(last, [](const Open& a, const Open& b) { return Later{}(b, a); });
  constexpr std::size_t most = 20;
  if (last.size() > most) last.resize(most);
  for (Open& open : last) {
    open_
        .clear();  // goes_on() puts a leg back that costs more: its path is then no better than the known one
    if (!goes_on(open)) continue;
    const auto label = static_cast<std::uint32_t>(labels_.size());
    labels_.push_back({open.cost, open.heading_rad, open.candidate, open.parent, none});
    return TurnPath{.points = points_to(label),
                    .cost = open.cost + least_rest(candidates_[goal_candidate], open.heading_rad)};
  }
  return std::nullopt;
}

/// False when there are too many.
bool VisibilityGraphSearch::gather_candidates(std::span<const Vec2> known) {
  constexpr std::size_t most_looked_at = 6;  // times as many: a longer list is not worth the look
  if (turn_points_.size() > most_looked_at * limits_.complete) return false;
  candidates_.clear();
  add_candidate(goal_, none);
  for (const Vec2& point : known.subspan(1, known.size() - 2)) add_candidate(point, none);
  for (std::uint32_t i = 0; i < turn_points_.size(); ++i) {
    if (turn_points_[i].tight || cost_->counts_turns()) add_candidate(turn_points_[i].position, i);
  }
  if (candidates_.size() > limits_.complete) return false;
  legs_.resize(std::max(legs_.size(), candidates_.size() + 1));
  for (std::vector<Leg>& legs : legs_) legs.clear();
  sights_.assign((candidates_.size() + 1) * (candidates_.size() + 1), Sight::unknown);
  return true;
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
  from_ = {.position = position_of(from), .candidate = from.candidate};
  if (from.candidate != none) {
    const Candidate& at = candidates_[from.candidate];
    from_.turn_point = at.turn_point;
    from_.arrival = from_.position - position_of(labels_[from.parent]);
    from_.to_corner = at.corner - at.position;
    from_.corner_side = cross(from_.arrival, from_.to_corner);
  }
  const std::vector<Leg>& legs = legs_from(from.candidate);
  work_ += legs.size();
  for (const Leg& leg : legs) consider(label, leg);
}

/// Listed when a candidate is expanded first.
const std::vector<VisibilityGraphSearch::Leg>& VisibilityGraphSearch::legs_from(std::uint32_t candidate) {
  std::vector<Leg>& legs = legs_[place_of(candidate)];
  if (!legs.empty()) return legs;
  const Vec2& position = candidate == none ? start_ : candidates_[candidate].position;
  for (std::uint32_t to = 0; to < candidates_.size(); ++to) {
    const Vec2 way = candidates_[to].position - position;
    const double length_cells = way.norm();
    if (to == candidate || way.isZero(0.0)) continue;
    legs.push_back({.cost = cost_->at_least(length_cells),
                    .heading_rad = cost_->counts_turns() ? heading_of(way) : 0.0,
                    .to = to});
  }
  constexpr std::size_t units = 4;
  work_ += units * candidates_.size();
  return legs;
}

void VisibilityGraphSearch::consider(std::uint32_t label, const Leg& leg) {
  const Label& from = labels_[label];
  const Candidate& to = candidates_[leg.to];
  const bool at_start = from.candidate == none;
  const double cost = from.cost + leg.cost;
  if (cost + to.least_to_goal >= limit_) return;
  if (!turns_around_its_corner(to.position - from_.position) ||
      sight(from.candidate, leg.to) == Sight::blocked)
    return;
  Open open{.total = cost + to.least_to_goal, .cost = cost, .candidate = leg.to, .parent = label};
  if (cost_->counts_turns()) {
    open.heading_rad = leg.heading_rad;
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
  if (!sees(parent.candidate, open.candidate)) return false;
  if (!cost_->counts_cells()) return true;
  const Vec2& from = position_of(parent);
  const Vec2& to = candidates_[open.candidate].position;
  const double length_cells = (to - from).norm();
  work_ += static_cast<std::size_t>(length_cells);
  const double more = cost_->leg(from, to) - cost_->at_least(length_cells);
  if (more <= 0.0) return true;
  open.looked_at = true;
  open.cost += more;
  open.total += more;
  const double least = open.cost + least_rest(candidates_[open.candidate], open.heading_rad);  // not inflated
  if (least < limit_) push(open);
  return false;
}

VisibilityGraphSearch::Sight& VisibilityGraphSearch::sight(std::uint32_t from, std::uint32_t to) {
  const std::size_t a = place_of(from);
  const std::size_t b = place_of(to);
  return sights_[std::min(a, b) * (candidates_.size() + 1) + std::max(a, b)];
}

/// Each line of sight is checked once.
bool VisibilityGraphSearch::sees(std::uint32_t from, std::uint32_t to) {
  Sight& known = sight(from, to);
  if (known == Sight::unknown) {
    const Vec2& begin = from == none ? start_ : candidates_[from].position;
    const Vec2& end = candidates_[to].position;
    work_ += work_of_check((end - begin).norm());
    known = space_.along(begin, end) ? Sight::clear : Sight::blocked;
  }
  return known == Sight::clear;
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
