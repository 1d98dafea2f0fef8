#include "planning/jump_table.hpp"

#include <limits>

namespace lodestar {
namespace {

/// One step more than the neighbour's jump. A jump too long for the table is split, which costs one more
/// expansion.
std::int16_t one_more(std::int16_t jump) {
  constexpr std::int16_t longest = std::numeric_limits<std::int16_t>::max();
  if (jump == longest || jump == -longest) return 1;
  return static_cast<std::int16_t>(jump > 0 ? jump + 1 : jump - 1);
}

bool has(NeighbourMask neighbours, int direction) {
  return ((neighbours >> direction) & 1) != 0;
}

}  // namespace

JumpTable::JumpTable(const CollisionChecker& space)
    : columns_(space.columns()),
      rows_(space.rows()),
      jumps_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)),
      neighbours_(jumps_.size()) {
  find_neighbours(space);
  for (const int direction : {0, 2, 4, 6}) fill(direction);
  for (const int direction : {1, 3, 5, 7})
    fill(direction);  // after the straight ones, which a diagonal jump uses
}

void JumpTable::find_neighbours(const CollisionChecker& space) {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      if (!space.at({column, row})) continue;
      for (std::size_t k = 0; k < grid_steps.size(); ++k) {
        // Marks this clear cell in each neighbour's mask.
        const Cell beside{column - grid_steps[k].column, row - grid_steps[k].row};
        if (beside.column < 0 || beside.row < 0 || beside.column >= columns_ || beside.row >= rows_) continue;
        neighbours_[index(beside)] = static_cast<NeighbourMask>(neighbours_[index(beside)] | (1U << k));
      }
    }
  }
}

/// Fills in an order in which the neighbour's jump is known: directions 0 to 3 lead to a higher index, 4 to 7
/// to a lower one.
void JumpTable::fill(int direction) {
  const std::size_t count = jumps_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t cell = direction < 4 ? count - 1 - i : i;
    jumps_[cell][static_cast<std::size_t>(direction)] = jump_from(cell, direction);
  }
}

std::int16_t JumpTable::jump_from(std::size_t cell, int direction) const {
  const NeighbourMask around = neighbours_[cell];
  if (!has(around, direction)) return 0;
  const Cell step = grid_steps[static_cast<std::size_t>(direction)];
  const auto next =
      static_cast<std::size_t>(static_cast<std::ptrdiff_t>(cell) + step.row * columns_ + step.column);
  const auto jump = [&](int towards) { return jumps_[next][static_cast<std::size_t>(towards)]; };
  if (!is_diagonal(direction)) {
    return is_jump_point(direction, neighbours_[next]) ? std::int16_t{1} : one_more(jump(direction));
  }
  const int left = turned(direction, 1);
  const int right = turned(direction, -1);
  if (!has(around, left) || !has(around, right)) return 0;  // would cut a corner
  return jump(left) > 0 || jump(right) > 0 ? std::int16_t{1} : one_more(jump(direction));
}

}  // namespace lodestar
