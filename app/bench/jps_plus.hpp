#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "planning/jump_table.hpp"

namespace lodestar {

/// The peer of JumpSearch in its bench: JPS+ with pruned intermediate points, often called JPS2+, as
/// published (Harabor and Grastien, "Improving Jump Point Search", ICAPS 2014): from the same tables, but
/// with all successors of an expanded cell collected first, lengths in doubles, nodes in blocks that are made
/// when they are reached, and a binary heap in which a node moves up when it is reached on a shorter way.
class JpsPlus {
 public:
  /// The table must outlive it.
  explicit JpsPlus(const JumpTable& jumps);

  /// Length of the shortest 8-connected path in cells; nothing without one. Both cells must be clear.
  std::optional<double> find(Cell start, Cell goal);
  /// Of the path found last: the cells that were expanded, from the goal back to the start. Between two of
  /// them the path may have a diagonal and then a straight part.
  [[nodiscard]] const std::vector<Cell>& expanded_on_path() const { return on_path_; }

 private:
  struct Node {
    std::uint32_t index = 0;
    std::uint32_t parent = 0;
    std::uint32_t search = 0;    ///< the last that reached it
    std::uint32_t place = 0;     ///< in the heap
    std::int32_t direction = 0;  ///< of arrival
    bool expanded = false;
    double length = 0.0;
    double total = 0.0;
  };
  struct Successor {
    Cell cell;
    int direction = 0;
    double length = 0.0;  ///< from the cell that is expanded
  };
  static constexpr std::uint32_t block_bits = 6;
  static constexpr std::uint32_t block_size = 1U << block_bits;

  [[nodiscard]] std::uint32_t index(Cell cell) const;
  [[nodiscard]] Cell cell_at(std::uint32_t index) const;
  Node& node_of(std::uint32_t index);
  void expand(Cell cell, unsigned directions);
  void jump_straight(Cell from, int direction, double length);
  void jump_diagonally(Cell from, int direction);
  void reach(const Successor& successor, const Node& from);
  static bool is_before(const Node& a, const Node& b);
  void push(Node& node);
  void move_up(std::uint32_t place);
  Node& pop();
  void trace_back();

  const JumpTable& jumps_;
  Cell goal_;
  std::uint32_t search_ = 0;
  std::vector<std::unique_ptr<std::array<Node, block_size>>> blocks_;
  std::vector<Node*> heap_;
  std::vector<Successor> successors_;
  std::vector<Cell> on_path_;
};

}  // namespace lodestar
