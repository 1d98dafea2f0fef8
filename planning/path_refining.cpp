#include "planning/path_refining.hpp"

#include <algorithm>

#include "planning/path_draft.hpp"
#include "planning/turn_merging.hpp"

namespace lodestar {
namespace {

/// A direct leg is never longer nor slower, but may lead over cells that cost more.
bool is_better_without(PathDraft& path, std::size_t turn) {
  if (!path.space.along(path.points[turn - 1], path.points[turn + 1])) return false;
  if (!path.cost.counts_cells()) return true;
  std::vector<Vec2> fewer = path.points;
  fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(turn));
  return path.cost.path(fewer, path.headings) <= path.cost.path(path.points, path.headings);
}

void leave_out_turns(PathDraft& path) {
  for (std::size_t turn = 1; turn + 1 < path.points.size();) {
    if (is_better_without(path, turn)) {
      path.points.erase(path.points.begin() + static_cast<std::ptrdiff_t>(turn));
    } else {
      ++turn;
    }
  }
}

void straighten_all(PathDraft& path) {
  for (std::size_t turn = 1; turn + 1 < path.points.size();)
    if (!straighten(path, turn)) ++turn;
}

/// Pattern search: each turn has its own step, which shrinks where nothing costs less. What moved wakes the
/// turns beside it.
void move_turns(PathDraft& path, bool and_legs, double least_step_cells) {
  constexpr double shrink = 0.35;
  constexpr double wake = 0.3;
  constexpr int most_rounds = 30;
  std::vector<double> steps(path.points.size(), path.space.radius_cells());
  bool is_done = false;
  for (int round = 0; round < most_rounds && !is_done; ++round) {
    is_done = true;
    for (std::size_t turn = 1; turn + 1 < path.points.size(); ++turn) {
      double& step = steps[turn];
      if (step < least_step_cells) continue;
      is_done = false;
      const bool turn_moved = move_turn(path, turn, step);
      const bool leg_moved = and_legs && slide_leg(path, turn, step);
      if (turn_moved || leg_moved) {
        for (const std::size_t beside : {turn - 1, turn + 1})
          steps[beside] = std::max(steps[beside], wake * step);
      } else {
        step *= shrink;
      }
    }
  }
}

}  // namespace

CountedPath refined(std::vector<Vec2> points, const EndHeadings& headings, const CollisionChecker& space,
                    const PathCost& cost, Refinement refinement) {
  if (points.size() < 3) return {std::move(points), 0};
  PathDraft path(std::move(points), headings, space, cost);
  leave_out_turns(path);
  if (cost.counts_turns()) {
    CountedPath merged = with_turns_merged(std::move(path.points), headings, space, cost);
    path.points = std::move(merged.points);
    path.work += merged.work;
  }
  const bool and_legs = refinement != Refinement::quick && cost.counts_turns();
  if (and_legs) straighten_all(path);
  move_turns(path, and_legs, (refinement == Refinement::fine ? 0.004 : 0.1) * space.radius_cells());
  leave_out_turns(path);
  return {std::move(path.points), path.work};
}

}  // namespace lodestar
