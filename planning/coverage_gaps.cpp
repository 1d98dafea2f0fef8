#include "planning/coverage_gaps.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestar {
namespace {

/// Gaps of less are corners that the camera sees all the same: lanes are closer together than it sees.
constexpr double least_gap_m2 = 0.05;

class Gaps {
 public:
  Gaps(const CollisionChecker& roomy, const std::vector<bool>& floor, double reach_m)
      : roomy_(roomy),
        map_(roomy.map()),
        floor_(floor),
        left_(floor),
        is_in_gap_(floor.size(), false),
        reach_m_(reach_m) {}

  /// What is near enough to the lane is no gap any more.
  void cover(const Lane& lane) {
    constexpr double step_cells = 2.0;
    const Vec2 way_m = lane.to_m - lane.from_m;
    const int steps = static_cast<int>(std::ceil(way_m.norm() / (step_cells * map_.resolution_m)));
    for (int i = 0; i <= steps; ++i) cover(lane.from_m + way_m * i / std::max(1, steps));
  }

  /// Goes through the middles of all that is left.
  std::vector<Lane> fill() {
    std::vector<Lane> lanes;
    const auto least = static_cast<std::size_t>(least_gap_m2 / square(map_.resolution_m));
    for (int row = 0; row < map_.rows; ++row) {
      for (int column = 0; column < map_.columns; ++column) {
        while (left_[map_.index({column, row})]) {
          const std::vector<Cell> gap = gap_at({column, row});
          if (gap.size() <= least) {
            for (const Cell cell : gap) left_[map_.index(cell)] = false;
            continue;
          }
          const Cell middle = middle_of(gap);
          lanes.push_back(through(gap, middle));
          cover(lanes.back());
          left_[map_.index(middle)] = false;  // even where no lane is near enough: each round leaves less
        }
      }
    }
    return lanes;
  }

 private:
  void cover(const Vec2& place_m) {
    const Vec2 place = place_m / map_.resolution_m;
    const Cell at = map_.cell_at(place_m);
    const int reach = static_cast<int>(reach_m_ / map_.resolution_m);
    for (int row = std::max(0, at.row - reach); row <= std::min(map_.rows - 1, at.row + reach); ++row) {
      for (int column = std::max(0, at.column - reach);
           column <= std::min(map_.columns - 1, at.column + reach); ++column) {
        if (!left_[map_.index({column, row})]) continue;
        const Vec2 center(column + 0.5, row + 0.5);
        if ((center - place).norm() <= reach && roomy_.along(place, center))
          left_[map_.index({column, row})] = false;
      }
    }
  }

  /// The connected cells of a gap.
  [[nodiscard]] std::vector<Cell> gap_at(Cell first) {
    std::vector<Cell> gap{first};
    is_in_gap_[map_.index(first)] = true;
    for (std::size_t i = 0; i < gap.size(); ++i) {
      const Cell cell = gap[i];
      const std::array<Cell, 4> beside{Cell{cell.column - 1, cell.row}, Cell{cell.column + 1, cell.row},
                                       Cell{cell.column, cell.row - 1}, Cell{cell.column, cell.row + 1}};
      for (const Cell next : beside) {
        if (!map_.contains(next) || !left_[map_.index(next)] || is_in_gap_[map_.index(next)]) continue;
        is_in_gap_[map_.index(next)] = true;
        gap.push_back(next);
      }
    }
    for (const Cell cell : gap) is_in_gap_[map_.index(cell)] = false;
    return gap;
  }

  /// The cell of the gap nearest to its mean.
  [[nodiscard]] static Cell middle_of(const std::vector<Cell>& gap) {
    Vec2 mean = Vec2::Zero();
    for (const Cell cell : gap) mean += Vec2(cell.column, cell.row) / static_cast<double>(gap.size());
    return *std::ranges::min_element(
        gap, {}, [&](Cell cell) { return (Vec2(cell.column, cell.row) - mean).squaredNorm(); });
  }

  /// The longer of the row's and the column's stretch of floor through the gap's middle, no farther than the
  /// gap goes.
  [[nodiscard]] Lane through(const std::vector<Cell>& gap, Cell middle) const {
    Eigen::AlignedBox2i box;
    for (const Cell cell : gap) box.extend(Eigen::Vector2i(cell.column, cell.row));
    const auto end = [&](Cell step) {
      Cell cell = middle;
      for (Cell next = middle;
           box.contains(Eigen::Vector2i(next.column, next.row)) && floor_[map_.index(next)];
           next = {next.column + step.column, next.row + step.row})
        cell = next;
      return map_.center_of(cell);
    };
    const Lane along_row{end({-1, 0}), end({1, 0})};
    const Lane along_column{end({0, -1}), end({0, 1})};
    const auto length = [](const Lane& lane) { return (lane.to_m - lane.from_m).norm(); };
    return length(along_row) >= length(along_column) ? along_row : along_column;
  }

  const CollisionChecker& roomy_;
  const OccupancyMap& map_;
  const std::vector<bool>& floor_;
  std::vector<bool> left_;
  std::vector<bool> is_in_gap_;  ///< while a gap is collected
  double reach_m_;
};

}  // namespace

std::vector<Lane> lanes_through_gaps(const CollisionChecker& roomy, const std::vector<bool>& floor,
                                     const std::vector<Lane>& lanes, double reach_m) {
  Gaps gaps(roomy, floor, reach_m);
  for (const Lane& lane : lanes) gaps.cover(lane);
  return gaps.fill();
}

}  // namespace lodestar
