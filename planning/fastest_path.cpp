#include "planning/fastest_path.hpp"

#include <utility>

#include "planning/path_refining.hpp"
#include "planning/turn_shortcuts.hpp"

namespace lodestar {
namespace {

/// The fastest of the paths found, once they are refined. Adds its work to `found.work`.
std::vector<Vec2> refined_best(TurnPath& found, const EndHeadings& headings, const CollisionChecker& space,
                               const PathCost& cost) {
  constexpr double most_saved_s = 1.5;  // measured: refining seldom saves more
  const auto refine = [&](std::vector<Vec2> points, Refinement refinement) {
    CountedPath path = refined(std::move(points), headings, space, cost, refinement);
    found.work += path.work;
    return std::move(path.points);
  };
  std::vector<Vec2> best = refine(std::move(found.points), Refinement::coarse);
  for (std::vector<Vec2>& other : found.others) {
    if (cost.path(other, headings) > cost.path(best, headings) + most_saved_s) continue;
    other = refine(std::move(other), Refinement::coarse);
    if (cost.path(other, headings) < cost.path(best, headings)) best.swap(other);
  }
  return refine(std::move(best), Refinement::fine);
}

}  // namespace

TurnPath fastest_path(std::vector<Vec2> known, const EndHeadings& headings, const CollisionChecker& space,
                      const PathCost& cost, VisibilityGraphSearch& turns, const TurnSearchLimits& limits) {
  CountedPath first = refined(std::move(known), headings, space, cost, Refinement::quick);
  TurnPath best{.points = std::move(first.points), .work = first.work};
  if (!cost.counts_cells()) {
    CountedPath straighter = with_shortcuts(std::move(best.points), headings, space, cost);
    best.points = std::move(straighter.points);
    best.work += straighter.work;
  }
  for (int round = 0; round < limits.rounds && best.points.size() > 2; ++round) {
    TurnPath found = turns.find(best.points, headings, cost, round);
    std::vector<Vec2> points = refined_best(found, headings, space, cost);
    if (cost.path(points, headings) < cost.path(best.points, headings)) best.points = std::move(points);
    best.expanded += found.expanded;
    best.work += found.work;
    if (best.work + found.work > limits.work_of_rounds) break;
  }
  best.cost = cost.path(best.points, headings);
  return best;
}

}  // namespace lodestar
