#include "planning/path_draft.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace lodestar {
namespace {

/// A place for one point, or for two in a row.
struct Change {
  double cost = 0.0;
  Vec2 first = Vec2::Zero();
  Vec2 second = Vec2::Zero();
};

struct Shift {
  double first = 0.0;
  double second = 0.0;
};

/// Unit direction from one point of the path to another; zero when they coincide.
Vec2 way(const PathDraft& path, std::size_t from, std::size_t to) {
  const Vec2 between = path.points[to] - path.points[from];
  const double length = between.norm();
  return length > 0.0 ? Vec2(between / length) : Vec2::Zero();
}

/// The first clear one of the changes of points `at` and `at` + 1, cheapest first.
bool take_best(PathDraft& path, std::size_t at, std::vector<Change>& changes) {
  std::ranges::stable_sort(changes, {}, &Change::cost);
  const auto [from, to] = path.part_around(at, at + 1);
  for (const Change& change : changes) {
    path.points[at] = change.first;
    path.points[at + 1] = change.second;
    if (path.is_clear(from, to)) return true;
  }
  return false;
}

}  // namespace

PathDraft::Part PathDraft::part_around(std::size_t first, std::size_t last) const {
  return {first > 0 ? first - 1 : 0, std::min(last + 1, points.size() - 1)};
}

EndHeadings PathDraft::headings_around(std::size_t first, std::size_t last) const {
  const auto [from, to] = part_around(first, last);
  return headings_of_part(points, from, to, headings);
}

double PathDraft::cost_around(std::size_t first, std::size_t last, const EndHeadings& around) {
  work += work_of_cost;
  const auto [from, to] = part_around(first, last);
  return cost.path(std::span(points).subspan(from, to - from + 1), around);
}

bool PathDraft::is_clear(std::size_t first, std::size_t last) {
  constexpr std::size_t units_to_look = 3;
  blocking_.resize(std::max(blocking_.size(), points.size()));
  for (std::size_t leg = first; leg < last; ++leg) {
    work += units_to_look;
    if (blocking_[leg] && space.is_blocked_by(*blocking_[leg], points[leg], points[leg + 1])) return false;
  }
  for (std::size_t leg = first; leg < last; ++leg) {
    work += work_of_check((points[leg + 1] - points[leg]).norm());
    if (!space.along(points[leg], points[leg + 1], blocking_[leg])) return false;
  }
  return true;
}

bool move_turn(PathDraft& path, std::size_t turn, double step_cells) {
  constexpr double slant = 0.7071067811865476;
  static constexpr std::array<Shift, 8> directions{
      {{1, 0}, {slant, slant}, {0, 1}, {-slant, slant}, {-1, 0}, {-slant, -slant}, {0, -1}, {slant, -slant}}};
  Vec2& point = path.points[turn];
  const Vec2 before = point;
  const EndHeadings around = path.headings_around(turn, turn);
  const double limit = path.cost_around(turn, turn, around) * (1.0 - worthwhile_saving);
  std::vector<Change> changes;
  for (const auto& [x, y] : directions) {
    point = before + step_cells * Vec2(x, y);
    const double cost = path.cost_around(turn, turn, around);
    if (cost < limit) changes.push_back({.cost = cost, .first = point});
  }
  std::ranges::stable_sort(changes, {}, &Change::cost);
  for (const Change& change : changes) {
    point = change.first;
    if (path.is_clear(turn - 1, turn + 1)) return true;
  }
  point = before;
  return false;
}

bool slide_leg(PathDraft& path, std::size_t turn, double step_cells) {
  if (turn + 2 >= path.points.size()) return false;
  static constexpr std::array<Shift, 12> shifts{{{1, 1},
                                                 {1, -1},
                                                 {-1, 1},
                                                 {-1, -1},
                                                 {1, 0.1},
                                                 {1, -0.1},
                                                 {-1, 0.1},
                                                 {-1, -0.1},
                                                 {0.1, 1},
                                                 {0.1, -1},
                                                 {-0.1, 1},
                                                 {-0.1, -1}}};
  const Vec2 from = path.points[turn];
  const Vec2 to = path.points[turn + 1];
  const Vec2 on_from = way(path, turn - 1, turn);
  const Vec2 on_to = way(path, turn + 2, turn + 1);
  const EndHeadings around = path.headings_around(turn, turn + 1);
  const double limit = path.cost_around(turn, turn + 1, around) * (1.0 - worthwhile_saving);
  std::vector<Change> changes;
  for (const Shift& shift : shifts) {
    path.points[turn] = from + shift.first * step_cells * on_from;
    path.points[turn + 1] = to + shift.second * step_cells * on_to;
    const double cost = path.cost_around(turn, turn + 1, around);
    if (cost < limit) changes.push_back({cost, path.points[turn], path.points[turn + 1]});
  }
  if (take_best(path, turn, changes)) return true;
  path.points[turn] = from;
  path.points[turn + 1] = to;
  return false;
}

bool straighten(PathDraft& path, std::size_t turn) {
  static constexpr std::array radii{0.0, 0.1, -0.1, 0.3, -0.3, 1.0, -1.0, 3.0, -3.0};
  const bool is_first = turn == 1;
  const bool is_last = turn + 2 == path.points.size();
  const std::vector<Vec2> whole = path.points;
  const Vec2 on_from = is_first ? Vec2::Zero() : way(path, turn - 2, turn - 1);
  const Vec2 on_to = is_last ? Vec2::Zero() : way(path, turn + 2, turn + 1);
  const EndHeadings around = path.headings_around(turn - 1, turn + 1);
  const double limit = path.cost_around(turn - 1, turn + 1, around) * (1.0 - worthwhile_saving);
  path.points.erase(path.points.begin() + static_cast<std::ptrdiff_t>(turn));
  std::vector<Change> changes;
  for (const double shift_from : std::span(radii).first(is_first ? 1 : radii.size())) {
    for (const double shift_to : std::span(radii).first(is_last ? 1 : radii.size())) {
      path.points[turn - 1] = whole[turn - 1] + shift_from * path.space.radius_cells() * on_from;
      path.points[turn] = whole[turn + 1] + shift_to * path.space.radius_cells() * on_to;
      constexpr std::size_t units = 3;
      path.work += units;
      if (path.space.is_surely_blocked(path.points[turn - 1], path.points[turn])) continue;
      const double cost = path.cost_around(turn - 1, turn, around);
      if (cost < limit) changes.push_back({cost, path.points[turn - 1], path.points[turn]});
    }
  }
  if (take_best(path, turn - 1, changes)) return true;
  path.points = whole;
  return false;
}

}  // namespace lodestar
