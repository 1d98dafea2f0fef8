#pragma once

#include <optional>

#include "control/drive_options.hpp"
#include "maps/geometry.hpp"

namespace lodestar {

/// A waypoint that is passed on an arc which touches both legs, instead of stopping to turn.
struct Corner {
  Vec2 center_m = Vec2::Zero();
  double radius_m = 0.0;
  double heading_rad = 0.0;  ///< where the arc begins: that of the leg before
  double turn_rad = 0.0;     ///< of the whole arc, counter-clockwise positive
  double cut_m = 0.0;        ///< from either end of the arc to the waypoint, along the legs
  double speed_mps = 0.0;    ///< along the arc
};

/// The corner at `waypoint`, no farther from it than options.blend_corridor_m. Nothing where the robot has to
/// stop: without such an option, at a sharp turn, between legs too short, or when the arc would be slower
/// than min_forward_mps.
std::optional<Corner> corner_at(const Vec2& before_m, const Vec2& waypoint_m, const Vec2& after_m,
                                const DriveOptions& options);

/// How far along the arc a point is, 0 at its beginning, and how far to the left of it.
struct OnCorner {
  double turned_rad = 0.0;  ///< towards the arc's end, positive
  double beside_m = 0.0;
};
OnCorner on_corner(const Corner& corner, const Vec2& point_m);

}  // namespace lodestar
