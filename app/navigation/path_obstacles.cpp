#include "app/navigation/path_obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lodestar {
namespace {

/// So close that no robot fits between two.
std::vector<Vec2> ring(const Vec2& middle_m, double radius_m) {
  constexpr double most_between_m = 0.15;
  const double count = std::max(12.0, std::ceil(2.0 * std::numbers::pi * radius_m / most_between_m));
  std::vector<Vec2> points_m(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const double turn_rad = 2.0 * std::numbers::pi * static_cast<double>(i) / count;
    points_m[i] = middle_m + radius_m * Vec2(std::cos(turn_rad), std::sin(turn_rad));
  }
  return points_m;
}

}  // namespace

bool PathObstacles::is_mapped(const Vec2& point_in_map) const {
  return explanation_.explains(point_in_map, (point_in_map - ends_.robot_m).norm());
}

void PathObstacles::add(const Vec2& hit_in_odom, double radius_m) {
  if (!is_mapped(map_from_odom_ * hit_in_odom)) add_also_if_mapped(hit_in_odom, radius_m);
}

void PathObstacles::add_also_if_mapped(const Vec2& hit_in_odom, double radius_m) {
  const Vec2 hit_in_map = map_from_odom_ * hit_in_odom;
  points_m_.push_back(hit_in_map);
  if (radius_m <= 0.0) return;
  for (const Vec2& point_m : ring(hit_in_map, radius_m))
    if ((point_m - ends_.robot_m).norm() > ends_.room_m && !is_mapped(point_m)) points_m_.push_back(point_m);
}

double PathObstacles::room_before_robot_m(const Vec2& hit_in_odom) const {
  return (map_from_odom_ * hit_in_odom - ends_.robot_m).norm() - ends_.room_m;
}

double PathObstacles::room_before_goals_m(const Vec2& hit_in_odom) const {
  const Vec2 hit_in_map = map_from_odom_ * hit_in_odom;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Goal& goal : ends_.goals) nearest_m = std::min(nearest_m, (hit_in_map - goal.position_m).norm());
  return nearest_m - ends_.room_m;
}

}  // namespace lodestar
