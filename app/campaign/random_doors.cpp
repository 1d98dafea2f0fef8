#include "app/campaign/random_doors.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include "app/navigation/navigation_setup.hpp"
#include "maps/map_overlay.hpp"
#include "maps/random.hpp"
#include "maps/ray_casting.hpp"
#include "planning/margin_planner.hpp"

namespace lodestar {
namespace {

constexpr double narrowest_m = 0.8;
constexpr double widest_m = 1.6;
constexpr double leaf_radius_m = 0.04;    ///< of one of the discs: half of a leaf's thickness
constexpr double between_discs_m = 0.07;  ///< less than a disc is wide: no beam passes
constexpr double slides_mps = 0.5;        ///< an automatic sliding door

std::optional<Path> way_of(const Site& site, const OccupancyMap& map) {
  const MarginPlanner planner(map, navigation_options(site.robot).planner);
  const PlanResult planned = planner.plan(site.start.position_m, site.goals.front().position_m);
  const auto* plan = std::get_if<Plan>(&planned);
  return plan == nullptr ? std::nullopt : std::optional(plan->path);
}

/// Across the way, from wall to wall; nothing where either is farther away than half the widest doorway.
std::optional<Doorway> gap_at(const OccupancyMap& map, const Vec2& place_m, double heading_rad) {
  const auto to_wall = [&](double turn_rad) {
    const double direction_rad = heading_rad + turn_rad;
    const std::optional<double> range_m = range_to_obstacle_m(map, place_m, direction_rad, widest_m);
    return range_m ? std::optional(
                         Vec2(place_m + *range_m * Vec2(std::cos(direction_rad), std::sin(direction_rad))))
                   : std::nullopt;
  };
  const std::optional<Vec2> left_m = to_wall(0.5 * std::numbers::pi);
  const std::optional<Vec2> right_m = to_wall(-0.5 * std::numbers::pi);
  if (!left_m || !right_m) return std::nullopt;
  return Doorway{*left_m, *right_m};
}

double width_m(const Doorway& door) {
  return (door.to_m - door.from_m).norm();
}

/// The leaf as it lies in the doorway, its discs from post to post.
std::vector<Vec2> leaf_of(const Doorway& door) {
  const auto count = static_cast<int>(std::ceil(width_m(door) / between_discs_m)) + 1;
  std::vector<Vec2> discs_m;
  for (int i = 0; i < count; ++i)
    discs_m.emplace_back(door.from_m + (door.to_m - door.from_m) * i / (count - 1.0));
  return discs_m;
}

}  // namespace

std::vector<Doorway> doorways_of(const Site& site) {
  constexpr double step_m = 0.1;
  constexpr double from_ends_m = 0.8;  ///< the robot does not begin or end in a doorway
  const OccupancyMap& map = site.map.map;
  const std::optional<Path> way = way_of(site, map);
  std::vector<Doorway> doorways;
  std::optional<Doorway> narrowest;
  const auto end_gap = [&] {
    if (narrowest) doorways.push_back(*narrowest);
    narrowest.reset();
  };
  for (std::size_t i = 0; way && i + 1 < way->waypoints_m.size(); ++i) {
    const Vec2 from_m = way->waypoints_m[i];
    const Vec2 leg_m = way->waypoints_m[i + 1] - from_m;
    for (double at_m = 0.0; at_m < leg_m.norm(); at_m += step_m) {
      const Vec2 place_m = from_m + at_m * leg_m.normalized();
      const bool is_between = (place_m - site.start.position_m).norm() > from_ends_m &&
                              (place_m - site.goals.front().position_m).norm() > from_ends_m;
      const auto gap = is_between ? gap_at(map, place_m, std::atan2(leg_m.y(), leg_m.x())) : std::nullopt;
      if (!gap || width_m(*gap) < narrowest_m || width_m(*gap) > widest_m) {
        end_gap();
      } else if (!narrowest || width_m(*gap) < width_m(*narrowest)) {
        narrowest = gap;
      }
    }
  }
  end_gap();
  return doorways;
}

std::vector<MovingDisc> random_door(const Site& site, std::uint64_t seed) {
  Random random(seed);
  const std::vector<Doorway> doorways = doorways_of(site);
  if (doorways.empty() || random.uniform() < 0.5) return {};
  const Doorway& door = doorways[random.below(doorways.size())];
  const std::vector<Vec2> leaf_m = leaf_of(door);
  const double shuts_s = random.uniform(1.0, 15.0);
  const double shut_for_s = random.uniform(5.0, 25.0);
  const bool may_stay = way_of(site, overlaid(site.map.map, leaf_m)).has_value();
  const bool opens = !may_stay || random.uniform() < 0.5;

  const Vec2 into_wall_m = door.from_m - door.to_m;  // where it waits, in the line of the wall
  const Duration slide = from_seconds(width_m(door) / slides_mps);
  const Duration shuts = from_seconds(shuts_s);
  const Duration shut = shuts + slide;
  const Duration open = shut + from_seconds(shut_for_s);
  std::vector<MovingDisc> discs;
  for (const Vec2& place_m : leaf_m) {
    DiscTrajectory way{
        .keys = {{Duration::zero(), place_m + into_wall_m}, {shuts, place_m + into_wall_m}, {shut, place_m}}};
    if (opens) {
      way.keys.push_back({open, place_m});
      way.keys.push_back({open + slide, place_m + into_wall_m});
    }
    discs.push_back({.radius_m = leaf_radius_m, .trajectory = std::move(way)});
  }
  return discs;
}

}  // namespace lodestar
