#include "planning/jump_search.hpp"

#include <algorithm>
#include <utility>

namespace lodestar {
namespace {

constexpr auto ways_table = [] {
  std::array<std::array<DirectionSet, 256>, 8> table{};
  for (std::size_t direction = 0; direction < table.size(); ++direction) {
    for (std::size_t mask = 0; mask < 256; ++mask) {
      table[direction][mask] = ways_on(static_cast<int>(direction), static_cast<NeighbourMask>(mask));
    }
  }
  return table;
}();

constexpr std::size_t small_map = std::size_t{1} << 20U;   // 16 MB of nodes
constexpr std::size_t first_room = std::size_t{1} << 16U;  // nodes in a hash table; a power of two

/// Spreads neighbouring cells (Fibonacci hashing, Knuth 1973).
std::size_t spread(std::uint32_t index, std::size_t room) {
  return static_cast<std::size_t>((index * 0x9e3779b97f4a7c15ULL) >> 20U) & (room - 1);
}

/// Of a diagonal leg followed by a straight one.
Cell end_of_diagonal(Cell from, Cell to) {
  const int steps = free_steps(from, to).diagonal;
  return {from.column + (to.column > from.column ? steps : -steps),
          from.row + (to.row > from.row ? steps : -steps)};
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

/// Nodes of earlier searches count as free.
template <typename Jumps>
typename JumpSearch<Jumps>::Node& JumpSearch<Jumps>::node_in_table(std::uint32_t index) {
  std::size_t at = spread(index, nodes_.size());
  while (nodes_[at].visit >= visit_ && indices_[at] != index) at = (at + 1) & (nodes_.size() - 1);
  if (nodes_[at].visit < visit_) {
    indices_[at] = index;
    nodes_[at].visit = 0;
  }
  return nodes_[at];
}

template <typename Jumps>
typename JumpSearch<Jumps>::Node& JumpSearch<Jumps>::add_to_table(std::uint32_t index) {
  make_room();
  return node_in_table(index) = {.length = std::numeric_limits<StepLength>::max(), .visit = visit_};
}

/// Doubles the hash table when it becomes half full with one node more.
template <typename Jumps>
void JumpSearch<Jumps>::make_room() {
  if (2 * ++reached_ <= nodes_.size()) return;
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
  while (!level_.empty() || !open_.empty()) {
    const Open next = take_next();
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
  level_.clear();
  level_total_ = free_length(start, goal);
  reached_ = 0;
  visit_ += 2;
  if (visit_ == 0) {  // wraps around after 2^31 searches
    std::ranges::fill(nodes_, Node{});
    visit_ = 2;
  }
  reach(start, 0, index(start), 0);
}

/// No total is below the last one (the heuristic is consistent), so those equal to it need no heap; the
/// newest of them is nearest to the goal, as a rule.
template <typename Jumps>
typename JumpSearch<Jumps>::Open JumpSearch<Jumps>::take_next() {
  if (level_.empty()) {
    std::ranges::pop_heap(open_, Later{});
    std::swap(open_.back(), level_.emplace_back());
    open_.pop_back();
    level_total_ = level_.back().total;
  }
  const Open next = level_.back();
  level_.pop_back();
  return next;
}

template <typename Jumps>
void JumpSearch<Jumps>::expand(Cell cell, unsigned directions) {
  const std::uint32_t at = index(cell);
  const StepLength length = node_of(at).length;
  const auto expand_towards = [&]<int direction>() {
    if (((directions >> static_cast<unsigned>(direction)) & 1U) == 0) return;
    if constexpr (is_diagonal(direction))
      expand_diagonal<direction>(cell, length, at);
    else
      expand_straight<direction>(cell, length, at);
  };
  [&]<int... direction>(std::integer_sequence<int, direction...>) {
    (expand_towards.template operator()<direction>(), ...);
  }(std::make_integer_sequence<int, grid_steps.size()>());
}

/// To the next jump point, or to the goal where it comes first.
template <typename Jumps>
template <int direction>
void JumpSearch<Jumps>::expand_straight(Cell from, StepLength length, std::uint32_t parent) {
  constexpr Cell step = grid_steps[direction];
  const int jump = jumps_.jump(from, direction);
  const int to_goal = (goal_.column - from.column) * step.column + (goal_.row - from.row) * step.row;
  const bool in_line = step.row == 0 ? goal_.row == from.row : goal_.column == from.column;
  const int steps = in_line && to_goal > 0 && to_goal <= std::abs(jump) ? to_goal : jump;
  if (steps <= 0) return;
  reach({from.column + steps * step.column, from.row + steps * step.row}, length + steps * straight_length,
        parent, direction);
}

/// From one cell to the next from which a straight jump leads on, or which is in the goal's row or column;
/// each is expanded at once. Ends where one was reached on a shorter way: what follows is shorter from there,
/// too. One that a straight step reaches on a way as long is settled with it: a shortest path goes on from
/// there only in directions in which one along the diagonal does. The ends of the straight jumps have the
/// cell where the diagonal began as parent.
template <typename Jumps>
template <int direction>
void JumpSearch<Jumps>::expand_diagonal(Cell from, StepLength length, std::uint32_t parent) {
  constexpr Cell step = grid_steps[direction];
  for (;;) {
    const int jump = jumps_.jump(from, direction);
    const int to_line =
        std::min((goal_.column - from.column) * step.column, (goal_.row - from.row) * step.row);
    const int steps = to_line > 0 && to_line <= std::abs(jump) ? to_line : jump;
    if (steps <= 0) return;
    from = {from.column + steps * step.column, from.row + steps * step.row};
    length += steps * diagonal_length;
    if (from == goal_) return reach(from, length, parent, direction);
    const std::uint32_t at = index(from);
    Node& node = node_to_reach(at);
    if (length > node.length) return;
    node = {.length = length, .parent = parent, .visit = visit_ + 1};
    expand_straight<turned(direction, 1)>(from, length, parent);
    expand_straight<turned(direction, -1)>(from, length, parent);
  }
}

template <typename Jumps>
void JumpSearch<Jumps>::reach(Cell cell, StepLength length, std::uint32_t parent, int direction) {
  const std::uint32_t at = index(cell);
  jumps_.prefetch(cell);
  Node& node = node_to_reach(at);
  if (length >= node.length) return;
  node = {.length = length, .parent = parent, .visit = visit_};
  const Open open{length + free_length(cell, goal_), at, direction};
  if (open.total == level_total_) {
    level_.push_back(open);
  } else {
    open_.push_back(open);
    std::ranges::push_heap(open_, Later{});
  }
}

template <typename Jumps>
JumpPath JumpSearch<Jumps>::path_found() {
  turns_.assign(1, goal_);
  StepCount steps;
  while (turns_.back() != start_) {
    const Cell to = turns_.back();
    const Cell from = cell_at(node_of(index(to)).parent);
    const StepCount legs = free_steps(from, to);
    steps.straight += legs.straight;
    steps.diagonal += legs.diagonal;
    if (legs.straight > 0 && legs.diagonal > 0) turns_.push_back(end_of_diagonal(from, to));
    turns_.push_back(from);
  }
  std::ranges::reverse(turns_);
  return {.turns = turns_, .steps = steps, .expanded = expanded_};
}

template class JumpSearch<JumpTable>;
template class JumpSearch<JumpScan>;

}  // namespace lodestar
