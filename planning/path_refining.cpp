#include "planning/path_refining.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "planning/turn_merging.hpp"

namespace lodestar {
namespace {

constexpr double worthwhile = 1e-6;  ///< least relative gain for moving a turn

class Refining {
 public:
  Refining(std::vector<Vec2> points, const EndHeadings& headings, const CollisionChecker& space,
           const PathCost& cost)
      : points_(std::move(points)), headings_(headings), space_(space), cost_(cost) {}

  std::vector<Vec2> run(Refinement refinement) {
    leave_out();
    if (cost_.counts_turns()) points_ = with_turns_merged(std::move(points_), headings_, space_, cost_);
    for (const double step : {1.0, 0.3, 0.1, 0.03, 0.01}) {
      if (refinement == Refinement::coarse && step < 0.3) break;
      constexpr int most_rounds = 6;
      for (int round = 0; round < most_rounds && move_all(step); ++round) {
      }
    }
    leave_out();
    return points_;
  }

 private:
  /// Cost of the part of the path that moving turn i changes.
  [[nodiscard]] double cost_around(std::size_t i) const {
    const std::size_t reach = cost_.counts_turns() ? 2 : 1;
    const std::size_t first = i > reach ? i - reach : 0;
    const std::size_t last = std::min(i + reach, points_.size() - 1);
    EndHeadings headings;
    if (first == 0) headings.start_rad = headings_.start_rad;
    if (last + 1 == points_.size()) headings.goal_rad = headings_.goal_rad;
    return cost_.path(std::span(points_).subspan(first, last - first + 1), headings);
  }

  bool move_all(double step) {
    bool moved = false;
    for (std::size_t i = 1; i + 1 < points_.size(); ++i) moved = move(i, step) || moved;
    return moved;
  }

  /// Moves turn i by a step in the first of eight directions that costs less.
  bool move(std::size_t i, double step) {
    constexpr double slant = 0.7071067811865476;
    static constexpr std::array<std::array<double, 2>, 8> directions{{{1, 0},
                                                                      {slant, slant},
                                                                      {0, 1},
                                                                      {-slant, slant},
                                                                      {-1, 0},
                                                                      {-slant, -slant},
                                                                      {0, -1},
                                                                      {slant, -slant}}};
    const Vec2 before = points_[i];
    const double cost = cost_around(i) * (1.0 - worthwhile);
    for (const auto& [x, y] : directions) {
      points_[i] = before + step * Vec2(x, y);
      if (cost_around(i) < cost && space_.along(points_[i - 1], points_[i]) &&
          space_.along(points_[i], points_[i + 1])) {
        return true;
      }
    }
    points_[i] = before;
    return false;
  }

  void leave_out() {
    for (std::size_t i = 1; i + 1 < points_.size();) {
      if (is_better_without(i)) {
        points_.erase(points_.begin() + static_cast<std::ptrdiff_t>(i));
      } else {
        ++i;
      }
    }
  }

  /// A direct leg is never longer nor slower, but may lead over cells that cost more.
  [[nodiscard]] bool is_better_without(std::size_t i) const {
    if (!space_.along(points_[i - 1], points_[i + 1])) return false;
    if (!cost_.counts_cells()) return true;
    std::vector<Vec2> fewer = points_;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
    return cost_.path(fewer, headings_) <= cost_.path(points_, headings_);
  }

  std::vector<Vec2> points_;
  EndHeadings headings_;
  const CollisionChecker& space_;
  const PathCost& cost_;
};

}  // namespace

std::vector<Vec2> refined(std::vector<Vec2> points, const EndHeadings& headings,
                          const CollisionChecker& space, const PathCost& cost, Refinement refinement) {
  return points.size() < 3 ? points : Refining(std::move(points), headings, space, cost).run(refinement);
}

}  // namespace lodestar
