#pragma once

#include <vector>

#include "control/field_scan.hpp"
#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// Where a beam of the newest scan ended, and what is known of it.
struct SeenPoint {
  Vec2 point_in_base = Vec2::Zero();
  Presence presence = Presence::person;
};

/// A cell of the obstacle memory that the map does not explain.
struct RememberedCell {
  Vec2 center_in_odom = Vec2::Zero();
  bool stands = false;  ///< for a second at least; else it moves, or has only just been seen
};

/// What the scanner shows of the robot's surroundings, for people to look at. Points are where they were
/// seen, from where the robot is now.
struct SeenSurroundings {
  Stamp stamp;                    ///< of the beam measured last
  std::vector<SeenPoint> points;  ///< none when the newest scan is too old for the protective field
  Pose2 base_from_odom;
  double cell_m = 0.0;  ///< side of the cells, which lie along the axes of the odometry frame
  std::vector<RememberedCell> cells;
};

}  // namespace lodestar
