#pragma once

#include <vector>

#include "planning/collision_checker.hpp"

namespace lodestar {

/// A place at which a good path may turn: beside a corner of an obstacle, just clear of it.
struct TurnPoint {
  Vec2 position = Vec2::Zero();  ///< in grid coordinates
  Vec2 corner = Vec2::Zero();    ///< of the obstacle that the path goes around here
  bool tight = true;  ///< as near to the corner as three turns around it allow; else as one turn does
};

/// Around every outer corner of the obstacles the robot's centre keeps to a quarter circle of its radius, or
/// goes on the polygon of straight legs about it. With a vertex for every 30 degrees (so with three turns a
/// quarter) the polygon is at most 2.4 % longer than the arc; with one for the whole arc the robot turns only
/// once. Of an arc that other obstacles take up in part, the open parts count. `reach_cells` is the arc's
/// radius: that of the robot, or more to keep away.
///
///        :    3      1 one turn
///        :  .    2   2, 3, 4 three turns
///     ###:.      .
///     #### . . . 4
std::vector<TurnPoint> turn_points(const CollisionChecker& space, double reach_cells);

}  // namespace lodestar
