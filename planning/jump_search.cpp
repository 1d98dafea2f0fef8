#include "planning/jump_search.hpp"

#include <algorithm>
#include <bit>

namespace lodestar {
namespace {

using DirectionSet = std::uint8_t;

/// Directions to expand after arriving in `direction` (natural and forced neighbours): straight on; after a
/// diagonal step also its two straight directions; after a straight step also towards forced neighbours.
constexpr DirectionSet ways_on(int direction, NeighbourMask neighbours) {
  unsigned ways = 1U << direction;
  const auto add = [&](int eighths) { ways |= 1U << turned(direction, eighths); };
  if (is_diagonal(direction)) {
    add(1);
    add(-1);
    return static_cast<DirectionSet>(ways);
  }
  for (const int side : {2, -2}) {
    if (!is_forced(direction, neighbours, side)) continue;
    add(side);
    add(side / 2);
  }
  return static_cast<DirectionSet>(ways);
}

constexpr auto ways_table = [] {
  std::array<std::array<DirectionSet, 256>, 8> table{};
  for (std::size_t direction = 0; direction < table.size(); ++direction) {
    for (std::size_t mask = 0; mask < 256; ++mask) {
      table[direction][mask] = ways_on(static_cast<int>(direction), static_cast<NeighbourMask>(mask));
    }
  }
  return table;
}();

constexpr unsigned all_directions = 0xff;
constexpr std::size_t small_map = std::size_t{1} << 20U;   // 16 MB of nodes
constexpr std::size_t first_room = std::size_t{1} << 16U;  // nodes in a hash table; a power of two

/// Spreads neighbouring cells (Fibonacci hashing, Knuth 1973).
std::size_t spread(std::uint32_t index, std::size_t room) {
  return static_cast<std::size_t>((index * 0x9e3779b97f4a7c15ULL) >> 20U) & (room - 1);
}

}  // namespace

/// Least total first; among equals the lower index.
template <typename Jumps>
struct JumpSearch<Jumps>::Later {
  bool operator()(const Open& a, const Open& b) const {
    return a.total != b.total ? a.total > b.total : a.index > b.index;
  }
};

template <typename Jumps>
JumpSearch<Jumps>::JumpSearch(const Jumps& jumps)
    : jumps_(jumps),
      nodes_(static_cast<std::size_t>(jumps.columns()) * static_cast<std::size_t>(jumps.rows()) <= small_map
                 ? static_cast<std::size_t>(jumps.columns()) * static_cast<std::size_t>(jumps.rows())
                 : first_room) {
  const bool has_all =
      nodes_.size() == static_cast<std::size_t>(jumps.columns()) * static_cast<std::size_t>(jumps.rows());
  if (!has_all) indices_.resize(nodes_.size());
}

/// In the hash table, nodes of earlier searches count as free.
template <typename Jumps>
typename JumpSearch<Jumps>::Node& JumpSearch<Jumps>::node_of(std::uint32_t index) {
  if (indices_.empty()) return nodes_[index];
  std::size_t at = spread(index, nodes_.size());
  while (nodes_[at].visit >= visit_ && indices_[at] != index) at = (at + 1) & (nodes_.size() - 1);
  if (nodes_[at].visit < visit_) {
    indices_[at] = index;
    nodes_[at].visit = 0;
  }
  return nodes_[at];
}

/// Doubles a hash table that becomes half full with one node more.
template <typename Jumps>
void JumpSearch<Jumps>::make_room() {
  if (indices_.empty() || 2 * ++reached_ <= nodes_.size()) return;
  const std::vector<Node> nodes = std::move(nodes_);
  const std::vector<std::uint32_t> indices = std::move(indices_);
  nodes_.assign(2 * nodes.size(), Node{});
  indices_.assign(2 * nodes.size(), 0);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].visit >= visit_) node_of(indices[i]) = nodes[i];
}

template <typename Jumps>
std::optional<JumpPath> JumpSearch<Jumps>::find(Cell start, Cell goal) {
  begin(start, goal);
  while (!open_.empty()) {
    const Open next = open_.front();
    std::ranges::pop_heap(open_, Later{});
    open_.pop_back();
    Node& node = node_of(next.index);
    if (node.visit != visit_) continue;  // stale: expanded before, at no greater length
    node.visit = visit_ + 1;
    ++expanded_;
    const Cell cell = cell_at(next.index);
    if (cell == goal_) return path_found();
    expand(cell, cell == start_
                     ? all_directions
                     : ways_table[static_cast<std::size_t>(next.direction)][jumps_.neighbours(cell)]);
  }
  return std::nullopt;
}

template <typename Jumps>
void JumpSearch<Jumps>::begin(Cell start, Cell goal) {
  start_ = start;
  goal_ = goal;
  expanded_ = 0;
  open_.clear();
  reached_ = 0;
  visit_ += 2;
  if (visit_ == 0) {  // wraps around after 2^31 searches
    std::ranges::fill(nodes_, Node{});
    visit_ = 2;
  }
  reach(start, 0, index(start), 0);
}

template <typename Jumps>
void JumpSearch<Jumps>::expand(Cell cell, unsigned directions) {
  const std::uint32_t at = index(cell);
  const StepLength length = node_of(at).length;
  for (; directions != 0; directions &= directions - 1) {
    const int direction = std::countr_zero(directions);
    const int steps = steps_towards(cell, direction);
    if (steps <= 0) continue;
    const Cell step = grid_steps[static_cast<std::size_t>(direction)];
    reach({cell.column + steps * step.column, cell.row + steps * step.row},
          length + steps * (is_diagonal(direction) ? diagonal_length : straight_length), at, direction);
  }
}

/// Steps to the next cell to expand in a direction: a jump point, the goal, or on a diagonal the cell in the
/// goal's row or column. Not above 0 when there is none.
template <typename Jumps>
int JumpSearch<Jumps>::steps_towards(Cell from, int direction) const {
  const int jump = jumps_.jump(from, direction);
  const Cell step = grid_steps[static_cast<std::size_t>(direction)];
  const Cell ahead{(goal_.column - from.column) * step.column, (goal_.row - from.row) * step.row};
  if (is_diagonal(direction)) {
    const int to_line = std::min(ahead.column, ahead.row);
    return to_line > 0 && to_line <= std::abs(jump) ? to_line : jump;
  }
  const int to_goal = ahead.column + ahead.row;
  const bool in_line = step.row == 0 ? goal_.row == from.row : goal_.column == from.column;
  return in_line && to_goal > 0 && to_goal <= std::abs(jump) ? to_goal : jump;
}

template <typename Jumps>
void JumpSearch<Jumps>::reach(Cell cell, StepLength length, std::uint32_t parent, int direction) {
  const std::uint32_t at = index(cell);
  const bool is_new = node_of(at).visit < visit_;
  if (is_new) make_room();
  Node& node = node_of(at);
  if (!is_new && length >= node.length) return;
  node = {.length = length, .parent = parent, .visit = visit_};
  open_.push_back({length + free_length(cell, goal_), at, direction});
  std::ranges::push_heap(open_, Later{});
}

template <typename Jumps>
JumpPath JumpSearch<Jumps>::path_found() {
  turns_.assign(1, goal_);
  StepCount steps;
  while (turns_.back() != start_) {
    const Cell before = cell_at(node_of(index(turns_.back())).parent);
    const StepCount leg = free_steps(before, turns_.back());
    steps.straight += leg.straight;
    steps.diagonal += leg.diagonal;
    turns_.push_back(before);
  }
  std::ranges::reverse(turns_);
  return {.turns = turns_, .steps = steps, .expanded = expanded_};
}

template class JumpSearch<JumpTable>;
template class JumpSearch<JumpScan>;

}  // namespace lodestar
