#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "planning/path_cost.hpp"
#include "planning/turn_search_limits.hpp"

namespace lodestar {

/// A clear path from start to goal while its turns are moved. In grid coordinates.
struct PathDraft {
  PathDraft(std::vector<Vec2> clear_points, const EndHeadings& end_headings, const CollisionChecker& checker,
            const PathCost& path_cost)
      : points(std::move(clear_points)), headings(end_headings), space(checker), cost(path_cost) {}

  /// Its legs change when points from `first` to `last` are moved.
  struct Part {
    std::size_t from = 0;
    std::size_t to = 0;
  };
  [[nodiscard]] Part part_around(std::size_t first, std::size_t last) const;

  /// Headings of the legs before and after that part.
  [[nodiscard]] EndHeadings headings_around(std::size_t first, std::size_t last) const;

  /// Cost of that part, with the turns from and to these headings.
  [[nodiscard]] double cost_around(std::size_t first, std::size_t last, const EndHeadings& around);

  /// Are the legs between these points clear? Remembers for each leg what blocked it, as most tries are
  /// blocked by the same cell.
  [[nodiscard]] bool is_clear(std::size_t first, std::size_t last);

  std::vector<Vec2> points;
  EndHeadings headings;
  const CollisionChecker& space;
  const PathCost& cost;
  std::size_t work = 0;  ///< as TurnSearchLimits count it

 private:
  std::vector<std::optional<Cell>> blocking_;  ///< by leg; only a hint
};

/// Each of these makes a path cheaper and keeps it clear, or leaves it as it is and says false. Turns are the
/// points from 1 to the last but one.

/// Moves a turn by a step in the best of eight directions.
bool move_turn(PathDraft& path, std::size_t turn, double step_cells);

/// Moves the leg from a turn to the next: each end slides on the line of the leg beside it. Where a long leg
/// just passes corners, no move of one end alone keeps it clear.
bool slide_leg(PathDraft& path, std::size_t turn, double step_cells);

/// Leaves out a turn; the turns beside it slide so that the leg between them is clear.
///
///     o              o
///      \      C       \             the leg from B to D is blocked; with both moved
///       B___--´--___D  B'_________D'  a little along their other legs, it is not
///                    \            \      .
///                     o            o
bool straighten(PathDraft& path, std::size_t turn);

}  // namespace lodestar
