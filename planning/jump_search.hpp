#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "planning/jump_scan.hpp"
#include "planning/jump_table.hpp"

namespace lodestar {

struct JumpPath {
  std::span<const Cell> turns;  ///< start, where the path turns, goal; valid until the next search
  StepCount steps;
  std::size_t expanded = 0;  ///< cells taken from the open list
};

/// The shortest path on the 8-connected grid of clear cells without cutting corners: jump point search, A*
/// that expands only cells where a path may have to turn, and those on a diagonal from which straight jumps
/// lead on without the open list (Harabor and Grastien 2012 and 2014). `Jumps` is JumpTable or JumpScan and
/// must outlive it. Memory is kept, so later searches hardly allocate.
template <typename Jumps>
class JumpSearch {
 public:
  explicit JumpSearch(const Jumps& jumps);

  /// Both cells must be clear. Nothing when there is no path. Deterministic.
  std::optional<JumpPath> find(Cell start, Cell goal);

 private:
  struct Node {
    StepLength length = 0;  ///< from the start
    std::uint32_t parent = 0;
    std::uint32_t visit = 0;  ///< twice the search's number, plus one when expanded; lower: not reached yet
  };
  struct Open {
    StepLength total = 0;  ///< length so far plus heuristic
    std::uint32_t index = 0;
    std::int32_t direction = 0;  ///< of arrival
  };
  struct Later;

  [[nodiscard]] std::uint32_t index(Cell cell) const {
    return static_cast<std::uint32_t>(cell.row) * static_cast<std::uint32_t>(jumps_.columns()) +
           static_cast<std::uint32_t>(cell.column);
  }
  /// The cell's node; one that no search has reached when the present search has not. Called for every cell
  /// that a jump leads to: what a small map needs is inlined there.
  Node& node_of(std::uint32_t index) { return indices_.empty() ? nodes_[index] : node_in_table(index); }
  /// The same; its length is beyond any when the present search has not reached it.
  Node& node_to_reach(std::uint32_t index) {
    Node& node = node_of(index);
    if (node.visit >= visit_) return node;
    if (!indices_.empty()) return add_to_table(index);
    node.length = std::numeric_limits<StepLength>::max();
    return node;
  }
  Node& node_in_table(std::uint32_t index);
  Node& add_to_table(std::uint32_t index);
  void make_room();
  [[nodiscard]] Cell cell_at(std::uint32_t index) const {
    const auto columns = static_cast<std::uint32_t>(jumps_.columns());
    return {static_cast<int>(index % columns), static_cast<int>(index / columns)};
  }
  void begin(Cell start, Cell goal);
  Open take_next();
  void expand(Cell cell, unsigned directions);
  template <int direction>
  void expand_straight(Cell from, StepLength length, std::uint32_t parent);
  template <int direction>
  void expand_diagonal(Cell from, StepLength length, std::uint32_t parent);
  void reach(Cell cell, StepLength length, std::uint32_t parent, int direction);
  JumpPath path_found();

  const Jumps& jumps_;
  Cell start_;
  Cell goal_;
  std::uint32_t visit_ = 0;
  std::size_t expanded_ = 0;
  /// One for each cell of a small map; of a large one only those reached, in a hash table with linear
  /// probing.
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> indices_;  ///< of the nodes' cells in the hash table; empty on a small map
  std::size_t reached_ = 0;             ///< nodes in the hash table that the present search uses
  std::vector<Open> open_;              ///< heap, the least total first
  std::vector<Open> level_;             ///< taken before, the newest first: those of the least total
  StepLength level_total_ = 0;
  std::vector<Cell> turns_;
};

extern template class JumpSearch<JumpTable>;
extern template class JumpSearch<JumpScan>;

}  // namespace lodestar
