#pragma once

#include <vector>

#include "planning/collision_checker.hpp"

namespace lodestar {

/// A vertex of the visibility graph: beside a corner of an obstacle, just clear of it.
struct TurnPoint {
  Vec2 position = Vec2::Zero();  ///< in grid coordinates
  Vec2 corner = Vec2::Zero();    ///< of the obstacle that the path goes around here
  bool tight = true;             ///< of the polygon with a turn every 30 degrees; else of that with one turn
};

/// Around every outer corner of the obstacles, the shortest path of the robot's centre is a quarter circle of
/// its radius; straight legs follow a polygon tangent to the arc. With a vertex every 30 degrees (three turns
/// a quarter) the polygon is at most 2.4 % longer than the arc; with one vertex for the whole arc the robot
/// turns only once. Where other obstacles block part of the arc, its clear parts are used. `reach_cells`:
/// radius of the arc, the robot's or more for clearance.
///
///        :    3      1 one turn
///        :  .    2   2, 3, 4 three turns
///     ###:.      .
///     #### . . . 4
std::vector<TurnPoint> turn_points(const CollisionChecker& space, double reach_cells);

}  // namespace lodestar
