#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "maps/travel_time.hpp"
#include "planning/footprint_collision_checker.hpp"
#include "planning/grid_step.hpp"

namespace lodestar {

struct FootprintPath {
  std::vector<Vec2> points;  ///< start, centres of cells, goal in grid coordinates
  double time_s = 0.0;
  std::size_t expanded = 0;  ///< pairs of cell and heading
};

/// The fastest rotate-then-drive path of a footprint over cell centres and eight headings (A* in SE(2)).
/// Every step and every turn by 45 degrees is checked against the cells that it sweeps, which are the same
/// everywhere. No half turns between steps, as both directions of turning would be equally short.
class FootprintSearch {
 public:
  /// The space must outlive it.
  FootprintSearch(const FootprintCollisionChecker& space, const MotionLimits& limits);

  /// Nothing when there is none.
  std::optional<FootprintPath> find(const Vec2& start, const Vec2& goal, const EndHeadings& headings);

 private:
  static constexpr std::uint32_t none = 0xffffffff;
  static constexpr int headings_count = 8;
  struct Node {
    double cost = 0.0;
    std::uint32_t parent = none;
    std::uint32_t visit = 0;
  };
  struct Open {
    double total = 0.0;
    double cost = 0.0;
    std::uint32_t state = 0;  ///< `none` is the goal
    std::uint32_t parent = none;
  };
  struct Later;
  /// Cached checks of a cell's steps and turns: a bit for each of the eight.
  struct Known {
    std::uint8_t steps_looked_at = 0;
    std::uint8_t steps_clear = 0;
    std::uint8_t turns_looked_at = 0;
    std::uint8_t turns_clear = 0;
  };
  /// The last leg, from a cell's centre to the goal.
  struct Landing {
    Cell cell;
    double heading_rad = 0.0;
    double cost = 0.0;
  };

  [[nodiscard]] std::uint32_t state_of(Cell cell, int heading) const;
  [[nodiscard]] Cell cell_of(std::uint32_t state) const;
  [[nodiscard]] bool are_free(const std::vector<Cell>& cells, Cell around) const;
  bool steps(Cell cell, int heading);
  bool turns_an_eighth(Cell cell, int heading);
  bool turns(Cell cell, int from, int to);
  [[nodiscard]] double turn_cost(double angle_rad) const;
  void seed(const Vec2& start, const EndHeadings& headings, Cell goal);
  void find_landings(const Vec2& goal, const EndHeadings& headings);
  void expand(std::uint32_t state, Cell goal);
  void land(std::uint32_t state);
  void reach(Cell cell, int heading, double cost, std::uint32_t parent, Cell goal);
  [[nodiscard]] std::vector<Vec2> points_to(std::uint32_t state, const Vec2& start, const Vec2& goal) const;

  const FootprintCollisionChecker& space_;
  MotionLimits limits_;
  double cell_cost_s_;
  std::array<std::vector<Cell>, headings_count> step_cells_;  ///< swept by a step
  std::array<std::vector<Cell>, headings_count> turn_cells_;  ///< swept from one heading to the next
  std::vector<Known> known_;
  std::uint32_t visit_ = 0;
  std::vector<Node> nodes_;
  std::vector<Open> open_;
  std::vector<Landing> landings_;
};

}  // namespace lodestar
