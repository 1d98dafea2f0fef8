#pragma once

#include <optional>

#include "control/drive_options.hpp"
#include "maps/geometry.hpp"

namespace lodestar {

/// A waypoint passed on an arc tangent to both legs, instead of stopping to turn.
struct Corner {
  Vec2 center_m = Vec2::Zero();
  double radius_m = 0.0;
  double heading_rad = 0.0;  ///< at the arc's beginning: that of the leg before
  double turn_rad = 0.0;     ///< of the whole arc, counter-clockwise positive
  double cut_m = 0.0;        ///< from either end of the arc to the waypoint, along the legs
  double speed_mps = 0.0;    ///< along the arc
};

/// The corner at `waypoint`; its arc passes within options.blend_corridor_m of it. Nothing where the robot
/// must stop: with the option 0, at a sharp or hardly any turn, or when the arc's speed is below
/// min_forward_mps (short legs).
std::optional<Corner> corner_at(const Vec2& before_m, const Vec2& waypoint_m, const Vec2& after_m,
                                const DriveOptions& options);

/// A point's progress along the arc, and its cross-track error.
struct OnCorner {
  double turned_rad = 0.0;  ///< 0 at the arc's beginning, positive towards its end
  double beside_m = 0.0;    ///< positive to the left
};
OnCorner on_corner(const Corner& corner, const Vec2& point_m);

}  // namespace lodestar
