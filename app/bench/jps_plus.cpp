#include "app/bench/jps_plus.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestar {
namespace {

double octile_distance(Cell from, Cell to) {
  return free_steps(from, to).length_cells();
}

Cell moved(Cell from, int direction, int steps) {
  const Cell step = grid_steps[static_cast<std::size_t>(direction)];
  return {from.column + steps * step.column, from.row + steps * step.row};
}

}  // namespace

JpsPlus::JpsPlus(const JumpTable& jumps)
    : jumps_(jumps),
      blocks_(
          (static_cast<std::size_t>(jumps.columns()) * static_cast<std::size_t>(jumps.rows()) >> block_bits) +
          1) {}

std::uint32_t JpsPlus::index(Cell cell) const {
  return static_cast<std::uint32_t>(cell.row) * static_cast<std::uint32_t>(jumps_.columns()) +
         static_cast<std::uint32_t>(cell.column);
}

Cell JpsPlus::cell_at(std::uint32_t index) const {
  const auto columns = static_cast<std::uint32_t>(jumps_.columns());
  return {static_cast<int>(index % columns), static_cast<int>(index / columns)};
}

JpsPlus::Node& JpsPlus::node_of(std::uint32_t index) {
  auto& block = blocks_[index >> block_bits];
  if (!block) {
    block = std::make_unique<std::array<Node, block_size>>();
    for (std::uint32_t i = 0; i < block_size; ++i) (*block)[i].index = (index & ~(block_size - 1)) + i;
  }
  return (*block)[index & (block_size - 1)];
}

std::optional<double> JpsPlus::find(Cell start, Cell goal) {
  goal_ = goal;
  ++search_;
  heap_.clear();
  Node& first = node_of(index(start));
  first = {.index = first.index, .parent = first.index, .search = search_};
  push(first);
  while (!heap_.empty()) {
    Node& node = pop();
    node.expanded = true;
    if (node.index == index(goal)) {
      trace_back();
      return node.length;
    }
    const Cell cell = cell_at(node.index);
    expand(cell, &node == &first ? all_directions : ways_on(node.direction, jumps_.neighbours(cell)));
    for (const Successor& successor : successors_) reach(successor, node);
  }
  return std::nullopt;
}

void JpsPlus::expand(Cell cell, unsigned directions) {
  successors_.clear();
  for (int direction = 0; direction < static_cast<int>(grid_steps.size()); ++direction) {
    if (((directions >> static_cast<unsigned>(direction)) & 1U) == 0) continue;
    if (is_diagonal(direction))
      jump_diagonally(cell, direction);
    else
      jump_straight(cell, direction, 0.0);
  }
}

/// To the goal if it comes first. `length` leads up to `from`.
void JpsPlus::jump_straight(Cell from, int direction, double length) {
  const int jump = jumps_.jump(from, direction);
  const Cell step = grid_steps[static_cast<std::size_t>(direction)];
  const int to_goal = (goal_.column - from.column) * step.column + (goal_.row - from.row) * step.row;
  if (to_goal > 0 && to_goal <= std::abs(jump) && moved(from, direction, to_goal) == goal_)
    successors_.push_back({goal_, direction, length + to_goal});
  else if (jump > 0)
    successors_.push_back({moved(from, direction, jump), direction, length + jump});
}

/// The points on the diagonal are no successors; those are the ends of the straight jumps from them, and the
/// goal.
void JpsPlus::jump_diagonally(Cell from, int direction) {
  const Cell step = grid_steps[static_cast<std::size_t>(direction)];
  int steps = 0;
  for (int jump = jumps_.jump(from, direction);;) {
    steps += std::abs(jump);
    if (jump <= 0) break;
    const Cell at = moved(from, direction, steps);
    const double length = steps * std::numbers::sqrt2;
    for (const int side : {turned(direction, 1), turned(direction, -1)}) {
      const int on = jumps_.jump(at, side);
      if (on > 0) successors_.push_back({moved(at, side, on), side, length + on});
    }
    jump = jumps_.jump(at, direction);
  }
  const Cell ahead{(goal_.column - from.column) * step.column, (goal_.row - from.row) * step.row};
  const int to_line = std::min(ahead.column, ahead.row);
  if (to_line < 0 || to_line > steps) return;
  if (ahead.column == ahead.row) {
    successors_.push_back({goal_, direction, to_line * std::numbers::sqrt2});
    return;
  }
  const int across = step.column > 0 ? 0 : 4;
  const int up = step.row > 0 ? 2 : 6;
  jump_straight(moved(from, direction, to_line), ahead.column > ahead.row ? across : up,
                to_line * std::numbers::sqrt2);
}

void JpsPlus::reach(const Successor& successor, const Node& from) {
  Node& node = node_of(index(successor.cell));
  const double length = from.length + successor.length;
  const bool is_new = node.search != search_;
  if (!is_new && length >= node.length) return;
  const bool waits = !is_new && !node.expanded;
  node = {.index = node.index,
          .parent = from.index,
          .search = search_,
          .place = node.place,
          .direction = successor.direction,
          .length = length,
          .total = length + octile_distance(successor.cell, goal_)};
  if (waits)
    move_up(node.place);
  else
    push(node);
}

/// The longer of two with the same total is nearer to the goal.
bool JpsPlus::is_before(const Node& a, const Node& b) {
  return a.total < b.total || (a.total == b.total && a.length > b.length);
}

void JpsPlus::push(Node& node) {
  heap_.push_back(&node);
  move_up(static_cast<std::uint32_t>(heap_.size() - 1));
}

void JpsPlus::move_up(std::uint32_t place) {
  Node* const node = heap_[place];
  while (place > 0) {
    const std::uint32_t above = (place - 1) / 2;
    if (!is_before(*node, *heap_[above])) break;
    heap_[place] = heap_[above];
    heap_[place]->place = place;
    place = above;
  }
  heap_[place] = node;
  node->place = place;
}

JpsPlus::Node& JpsPlus::pop() {
  Node& first = *heap_.front();
  Node* const last = heap_.back();
  heap_.pop_back();
  const auto size = static_cast<std::uint32_t>(heap_.size());
  if (size == 0) return first;
  std::uint32_t place = 0;
  for (;;) {
    std::uint32_t below = 2 * place + 1;
    if (below >= size) break;
    if (below + 1 < size && is_before(*heap_[below + 1], *heap_[below])) ++below;
    if (!is_before(*heap_[below], *last)) break;
    heap_[place] = heap_[below];
    heap_[place]->place = place;
    place = below;
  }
  heap_[place] = last;
  last->place = place;
  return first;
}

void JpsPlus::trace_back() {
  on_path_.clear();
  for (std::uint32_t at = index(goal_);;) {
    on_path_.push_back(cell_at(at));
    const std::uint32_t parent = node_of(at).parent;
    if (parent == at) return;
    at = parent;
  }
}

}  // namespace lodestar
