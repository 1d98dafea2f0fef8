#include "planning/footprint_search.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

constexpr double eighth_rad = std::numbers::pi / 4.0;

std::array<Cell, 9> cells_about(const Vec2& point) {
  const Cell middle = cell_at(point);
  std::array<Cell, 9> cells;
  for (int i = 0; i < 9; ++i)
    cells.at(static_cast<std::size_t>(i)) = {middle.column + i % 3 - 1, middle.row + i / 3 - 1};
  return cells;
}

}  // namespace

/// Least total first; ties by state, so that the search is deterministic.
struct FootprintSearch::Later {
  bool operator()(const Open& a, const Open& b) const {
    return a.total != b.total ? a.total > b.total : a.state > b.state;
  }
};

FootprintSearch::FootprintSearch(const FootprintCollisionChecker& space, const MotionLimits& limits)
    : space_(space),
      limits_(limits),
      cell_cost_s_(space.map().resolution_m / limits.max_forward_mps),
      known_(space.map().cells.size()),
      nodes_(space.map().cells.size() * headings_count) {
  const double resolution_m = space.map().resolution_m;
  for (std::size_t k = 0; k < headings_count; ++k) {
    const double heading_rad = static_cast<double>(k) * eighth_rad;
    step_cells_.at(k) = space.footprint().cells_driving(resolution_m, heading_rad, grid_steps.at(k));
    turn_cells_.at(k) = space.footprint().cells_turning(resolution_m, heading_rad, eighth_rad);
  }
}

std::uint32_t FootprintSearch::state_of(Cell cell, int heading) const {
  return static_cast<std::uint32_t>(space_.map().index(cell)) * headings_count +
         static_cast<std::uint32_t>(heading);
}

Cell FootprintSearch::cell_of(std::uint32_t state) const {
  const auto columns = static_cast<std::uint32_t>(space_.map().columns);
  const std::uint32_t index = state / headings_count;
  return {static_cast<int>(index % columns), static_cast<int>(index / columns)};
}

bool FootprintSearch::are_free(const std::vector<Cell>& cells, Cell around) const {
  const OccupancyMap& map = space_.map();
  return std::ranges::all_of(cells, [&](Cell offset) {
    const Cell cell{around.column + offset.column, around.row + offset.row};
    return map.contains(cell) && is_drivable(map.at(cell));
  });
}

bool FootprintSearch::steps(Cell cell, int heading) {
  const Cell step = grid_steps.at(static_cast<std::size_t>(heading));
  const Cell to{cell.column + step.column, cell.row + step.row};
  if (!space_.inner().at(to)) return false;
  Known& known = known_[space_.map().index(cell)];
  const auto bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(heading));
  if ((known.steps_looked_at & bit) == 0) {
    known.steps_looked_at |= bit;
    const CollisionChecker& outer = space_.outer();
    const bool easy =
        outer.at(cell) && outer.at(to) && outer.at({to.column, cell.row}) && outer.at({cell.column, to.row});
    if (easy || are_free(step_cells_.at(static_cast<std::size_t>(heading)), cell)) known.steps_clear |= bit;
  }
  return (known.steps_clear & bit) != 0;
}

/// Counter-clockwise from this heading to the next; the turn back sweeps the same cells.
bool FootprintSearch::turns_an_eighth(Cell cell, int heading) {
  Known& known = known_[space_.map().index(cell)];
  const auto bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(heading));
  if ((known.turns_looked_at & bit) == 0) {
    known.turns_looked_at |= bit;
    if (space_.outer().at(cell) || are_free(turn_cells_.at(static_cast<std::size_t>(heading)), cell))
      known.turns_clear |= bit;
  }
  return (known.turns_clear & bit) != 0;
}

/// Is the turn clear, the shorter way? False for a half turn.
bool FootprintSearch::turns(Cell cell, int from, int to) {
  const int eighths = turned(to, -from);
  if (eighths == headings_count / 2) return false;
  const int begin = eighths < headings_count / 2 ? from : to;
  const int count = std::min(eighths, headings_count - eighths);
  for (int i = 0; i < count; ++i) {
    if (!turns_an_eighth(cell, turned(begin, i))) return false;
  }
  return true;
}

/// Time of a turn, plus that of braking before it and accelerating after it.
double FootprintSearch::turn_cost(double angle_rad) const {
  if (std::abs(angle_rad) < 1e-9) return 0.0;
  return limits_.turn_time_s(angle_rad) + limits_.max_forward_mps / limits_.max_acceleration_mps2;
}

std::optional<FootprintPath> FootprintSearch::find(const Vec2& start, const Vec2& goal,
                                                   const EndHeadings& headings) {
  ++visit_;
  open_.clear();
  const Cell goal_cell = cell_at(goal);
  find_landings(goal, headings);
  seed(start, headings, goal_cell);
  std::size_t expanded = 0;
  while (!open_.empty()) {
    const Open next = open_.front();
    std::ranges::pop_heap(open_, Later{});
    open_.pop_back();
    if (next.state == none) return FootprintPath{points_to(next.parent, start, goal), next.cost, expanded};
    if (next.cost > nodes_[next.state].cost) continue;
    ++expanded;
    land(next.state);
    expand(next.state, goal_cell);
  }
  return std::nullopt;
}

/// Opens with a leg from the start to the centre of each cell nearby, and a turn there to a grid heading.
void FootprintSearch::seed(const Vec2& start, const EndHeadings& headings, Cell goal) {
  for (const Cell cell : cells_about(start)) {
    if (!space_.inner().at(cell)) continue;
    const Vec2 center = center_of(cell);
    std::optional<double> arrival_rad = headings.start_rad;
    double cost = 0.0;
    if (center != start) {
      const double way_rad = heading_between(start, center);
      if (arrival_rad && !space_.turning(start, *arrival_rad, way_rad)) continue;
      if (!space_.driving(start, center)) continue;
      if (arrival_rad) cost += turn_cost(wrap_angle(way_rad - *arrival_rad));
      cost += cell_cost_s_ * (center - start).norm();
      arrival_rad = way_rad;
    }
    for (int k = 0; k < headings_count; ++k) {
      const double heading_rad = wrap_angle(k * eighth_rad);
      const double from_rad = arrival_rad.value_or(heading_rad);
      if (!space_.turning(center, from_rad, heading_rad)) continue;
      reach(cell, k, cost + turn_cost(wrap_angle(heading_rad - from_rad)), none, goal);
    }
  }
}

void FootprintSearch::find_landings(const Vec2& goal, const EndHeadings& headings) {
  landings_.clear();
  for (const Cell cell : cells_about(goal)) {
    const Vec2 center = center_of(cell);
    if (!space_.inner().at(cell)) continue;
    if (center == goal) continue;  // reached from the landing of a neighbour
    const double way_rad = heading_between(center, goal);
    if (!space_.driving(center, goal)) continue;
    if (headings.goal_rad && !space_.turning(goal, way_rad, *headings.goal_rad)) continue;
    const double turn_rad = headings.goal_rad ? wrap_angle(*headings.goal_rad - way_rad) : 0.0;
    landings_.push_back({cell, way_rad, cell_cost_s_ * (goal - center).norm() + turn_cost(turn_rad)});
  }
}

void FootprintSearch::land(std::uint32_t state) {
  const Cell cell = cell_of(state);
  const double heading_rad = wrap_angle(static_cast<double>(state % headings_count) * eighth_rad);
  for (const Landing& landing : landings_) {
    if (landing.cell != cell || !space_.turning(center_of(cell), heading_rad, landing.heading_rad)) continue;
    const double cost =
        nodes_[state].cost + landing.cost + turn_cost(wrap_angle(landing.heading_rad - heading_rad));
    open_.push_back({cost, cost, none, state});
    std::ranges::push_heap(open_, Later{});
  }
}

void FootprintSearch::expand(std::uint32_t state, Cell goal) {
  const Cell cell = cell_of(state);
  const auto heading = static_cast<int>(state % headings_count);
  for (int k = 0; k < headings_count; ++k) {
    if (!steps(cell, k) || !turns(cell, heading, k)) continue;
    const Cell step = grid_steps.at(static_cast<std::size_t>(k));
    const double length = is_diagonal(k) ? std::numbers::sqrt2 : 1.0;
    const double turn_rad = eighth_rad * std::min(turned(k, -heading), turned(heading, -k));
    reach({cell.column + step.column, cell.row + step.row}, k,
          nodes_[state].cost + turn_cost(turn_rad) + cell_cost_s_ * length, state, goal);
  }
}

void FootprintSearch::reach(Cell cell, int heading, double cost, std::uint32_t parent, Cell goal) {
  const std::uint32_t state = state_of(cell, heading);
  Node& node = nodes_[state];
  if (node.visit == visit_ && cost >= node.cost) return;
  node = {.cost = cost, .parent = parent, .visit = visit_};
  constexpr double landing_cells = 3.0;  // keeps the heuristic admissible: the last leg may save this much
  const double rest = std::max(0.0, free_steps(cell, goal).length_cells() - landing_cells);
  open_.push_back({cost + cell_cost_s_ * rest, cost, state, parent});
  std::ranges::push_heap(open_, Later{});
}

std::vector<Vec2> FootprintSearch::points_to(std::uint32_t state, const Vec2& start, const Vec2& goal) const {
  std::vector<Vec2> points{goal};
  for (; state != none; state = nodes_[state].parent) points.push_back(center_of(cell_of(state)));
  if (points.back() != start) points.push_back(start);
  std::ranges::reverse(points);
  return points;
}

}  // namespace lodestar
