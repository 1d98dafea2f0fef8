#include "app/campaign/random_things.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <variant>

#include "app/navigation/navigation_setup.hpp"
#include "control/field_options.hpp"
#include "maps/random.hpp"
#include "planning/margin_planner.hpp"

namespace lodestar {
namespace {

constexpr std::uint64_t most_things = 3;
constexpr int tries = 20;
constexpr double from_start_and_goal_m = 1.0;  ///< beside the thing's own and the robot's radius
constexpr double pushed_mps = 0.8;
constexpr double pushed_mps2 = 0.8;  ///< from rest: within what the robot expects of what stands
constexpr double push_step_s = 0.1;
constexpr double pushed_m = 1.2;  ///< at most, and only over free floor

struct Thing {
  Vec2 position_m = Vec2::Zero();
  double radius_m = 0.0;
  bool is_chair = false;
};

Thing random_thing(const OccupancyMap& map, Random& random) {
  const Vec2 size_m(map.columns * map.resolution_m, map.rows * map.resolution_m);
  const Vec2 corner_m = map.center_of({0, 0}) - Vec2::Constant(0.5 * map.resolution_m);
  Thing thing;
  thing.position_m = corner_m + Vec2(random.uniform(0.0, size_m.x()), random.uniform(0.0, size_m.y()));
  thing.is_chair = random.uniform() < 0.4;
  thing.radius_m = thing.is_chair ? random.uniform(0.2, 0.28) : random.uniform(0.1, 0.3);
  return thing;
}

/// Of the way that remains: 11 cm a side beside things. Of a chair the scanner sees the legs, and the robot
/// keeps a body's room around them.
double keeps_m(const MovingDisc& thing) {
  constexpr double beside_m = 0.11;
  return thing.radius_m + (thing.has_legs ? ProtectiveFieldOptions{}.body_margin_m : beside_m);
}

bool is_free_round(const OccupancyMap& map, const Vec2& middle_m, double radius_m) {
  const Cell low = map.cell_at(middle_m - Vec2::Constant(radius_m));
  const Cell high = map.cell_at(middle_m + Vec2::Constant(radius_m));
  for (int row = low.row; row <= high.row; ++row)
    for (int column = low.column; column <= high.column; ++column) {
      const Cell cell{column, row};
      if ((map.center_of(cell) - middle_m).norm() > radius_m) continue;
      if (!map.contains(cell) || !is_drivable(map.at(cell))) return false;
    }
  return true;
}

/// Pushed there in a straight line over free floor, while the robot is still a metre away: what begins to
/// move beside a robot that creeps past it touches it (docs/safety.md).
DiscTrajectory pushed(const OccupancyMap& map, const Vec2& robot_m, const Thing& thing, Random& random) {
  const double direction_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
  const Vec2 along(std::cos(direction_rad), std::sin(direction_rad));
  double way_m = 0.0;
  while (way_m < pushed_m &&
         is_free_round(map, thing.position_m + (way_m + map.resolution_m) * along, thing.radius_m) &&
         (thing.position_m + (way_m + map.resolution_m) * along - robot_m).norm() >= from_start_and_goal_m)
    way_m += map.resolution_m;
  if (way_m == 0.0) return {.keys = {{Duration::zero(), thing.position_m}}};
  const double begins_s = random.uniform(0.5, 3.0);
  DiscTrajectory trajectory;
  for (double after_s = 0.0, moved_m = 0.0, speed_mps = 0.0; moved_m < way_m; after_s += push_step_s) {
    trajectory.keys.push_back(
        {from_seconds(begins_s + after_s), thing.position_m + (way_m - moved_m) * along});
    speed_mps = std::min(speed_mps + pushed_mps2 * push_step_s, pushed_mps);
    moved_m += speed_mps * push_step_s;
  }
  trajectory.keys.push_back({trajectory.keys.back().time + from_seconds(push_step_s), thing.position_m});
  return trajectory;
}

}  // namespace

std::optional<Path> way_of(const Site& site, const OccupancyMap& map) {
  const MarginPlanner planner(map, navigation_options(site.robot).planner);
  const PlanResult planned = planner.plan(site.start.position_m, site.goals.front().position_m);
  const auto* plan = std::get_if<Plan>(&planned);
  return plan == nullptr ? std::nullopt : std::optional(plan->path);
}

OccupancyMap with_things(OccupancyMap map, std::span<const MovingDisc> things) {
  for (const MovingDisc& thing : things) {
    const Vec2& position_m = thing.trajectory.keys.back().position_m;
    for (int row = 0; row < map.rows; ++row)
      for (int column = 0; column < map.columns; ++column) {
        const Cell cell{column, row};
        if ((map.center_of(cell) - position_m).norm() <= keeps_m(thing))
          map.cells[map.index(cell)] = OccupancyMap::occupied;
      }
  }
  return map;
}

std::vector<MovingDisc> random_things(const Site& site, std::uint64_t seed) {
  Random random(seed);
  OccupancyMap map = site.map.map;
  std::vector<MovingDisc> things;
  const std::uint64_t wanted = random.below(most_things + 1);
  for (int i = 0; i < tries && things.size() < wanted; ++i) {
    const Thing thing = random_thing(map, random);
    const double apart_m = from_start_and_goal_m + thing.radius_m + site.robot.radius_m;
    const auto is_near = [&](const Vec2& place_m) { return (place_m - thing.position_m).norm() < apart_m; };
    if (is_near(site.start.position_m) || is_near(site.goals.front().position_m)) continue;
    if (!is_free_round(map, thing.position_m, thing.radius_m)) continue;
    MovingDisc disc{.radius_m = thing.radius_m,
                    .has_legs = thing.is_chair,
                    .trajectory = {.keys = {{Duration::zero(), thing.position_m}}}};
    OccupancyMap with = with_things(map, {&disc, 1});
    if (!way_of(site, with)) continue;
    if (random.uniform() < 0.5) disc.trajectory = pushed(map, site.start.position_m, thing, random);
    things.push_back(std::move(disc));
    map = std::move(with);
  }
  return things;
}

}  // namespace lodestar
