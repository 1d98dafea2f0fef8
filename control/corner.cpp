#include "control/corner.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

/// At sharper corners the robot stops and turns. Chosen by hand: at 60 degrees a corridor of 5 cm gives an
/// arc of 0.32 m radius, driven at 0.14 m/s.
constexpr double sharpest_blended_rad = radians(60.0);

/// Unit vector to the left of a heading.
Vec2 left_of(double heading_rad) {
  return {-std::sin(heading_rad), std::cos(heading_rad)};
}

/// Speed limit of body and wheels on the arc. While the turn rate builds up, the heading lags the arc's by
/// v^2 / (2 R^2 a), which is kept below 0.05 rad; and the robot must still be able to stop on the next leg.
double arc_speed_mps(double radius_m, double next_leg_m, const DriveOptions& options) {
  constexpr double most_lag_rad = 0.05;
  constexpr double share_to_stop = 0.2;  // of the next leg; the corners at its ends cut up to 0.4 each
  const double by_turn = radius_m * options.max_turn_radps;
  const double by_wheel = options.max_wheel_mps / (1.0 + 0.5 * options.track_width_m / radius_m);
  const double by_turn_acceleration =
      radius_m * std::sqrt(2.0 * most_lag_rad * options.max_turn_acceleration_radps2);
  const double by_next_leg =
      std::sqrt(2.0 * braking_share * options.max_acceleration_mps2 * share_to_stop * next_leg_m);
  return std::min({options.max_forward_mps, by_turn, by_wheel, by_turn_acceleration, by_next_leg});
}

}  // namespace

std::optional<Corner> corner_at(const Vec2& before_m, const Vec2& waypoint_m, const Vec2& after_m,
                                const DriveOptions& options) {
  const Vec2 in = waypoint_m - before_m;
  const Vec2 out = after_m - waypoint_m;
  if (options.blend_corridor_m <= 0.0 || in.isZero() || out.isZero()) return std::nullopt;
  Corner corner;
  corner.heading_rad = heading_of(in);
  corner.turn_rad = wrap_angle(heading_of(out) - corner.heading_rad);
  const double half_rad = 0.5 * std::abs(corner.turn_rad);
  if (half_rad < 1e-3 || std::abs(corner.turn_rad) > sharpest_blended_rad) return std::nullopt;

  constexpr double longest_cut = 0.4;  // share of a leg, so that the corners at its two ends never overlap
  const double by_corridor = options.blend_corridor_m / (1.0 / std::cos(half_rad) - 1.0);
  const double by_legs = longest_cut * std::min(in.norm(), out.norm()) / std::tan(half_rad);
  corner.radius_m = std::min(by_corridor, by_legs);
  corner.cut_m = corner.radius_m * std::tan(half_rad);
  corner.speed_mps = arc_speed_mps(corner.radius_m, out.norm(), options);
  const double side = std::copysign(1.0, corner.turn_rad);
  corner.center_m =
      waypoint_m - corner.cut_m * in.normalized() + side * corner.radius_m * left_of(corner.heading_rad);
  if (corner.speed_mps < options.min_forward_mps) return std::nullopt;
  return corner;
}

OnCorner on_corner(const Corner& corner, const Vec2& point_m) {
  const double side = std::copysign(1.0, corner.turn_rad);
  const Vec2 from_center = point_m - corner.center_m;
  const double begins_rad = heading_of(-side * left_of(corner.heading_rad));
  return {side * wrap_angle(heading_of(from_center) - begins_rad),
          side * (corner.radius_m - from_center.norm())};
}

}  // namespace lodestar
