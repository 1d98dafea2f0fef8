#include "app/campaign/random_doors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "app/campaign/random_things.hpp"
#include "maps/map_overlay.hpp"
#include "maps/random.hpp"
#include "maps/ray_casting.hpp"

namespace lodestar {
namespace {

constexpr double narrowest_m = 0.8;
constexpr double widest_m = 1.6;

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

/// Points of the shut leaf, closer together than cells.
std::vector<Vec2> across(const Doorway& door, double resolution_m) {
  const auto steps = static_cast<int>(std::ceil(2.0 * width_m(door) / resolution_m));
  std::vector<Vec2> points_m;
  for (int i = 0; i <= steps; ++i) points_m.emplace_back(door.from_m + (door.to_m - door.from_m) * i / steps);
  return points_m;
}

/// The open leaf stands clear of the robot, and leaves room around the goal.
bool is_clear_of_ends(const SlidingDoor& door, const Site& site) {
  constexpr double beside_m = 0.1;
  const SlidingLeaf open(door);
  const auto is_clear = [&](const Vec2& place_m) {
    return std::ranges::all_of(open.discs(), [&](const DiscState& disc) {
      return (disc.position_m - place_m).norm() > site.robot.radius_m + disc.radius_m + beside_m;
    });
  };
  return is_clear(site.start.position_m) && is_clear(site.goals.front().position_m);
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

std::optional<SlidingDoor> random_door(const Site& site, std::span<const MovingDisc> things,
                                       std::uint64_t seed) {
  Random random(seed);
  const std::vector<Doorway> doorways = doorways_of(site);
  if (doorways.empty() || random.uniform() < 0.5) return std::nullopt;
  const Doorway& doorway = doorways[random.below(doorways.size())];
  SlidingDoor door{.from_m = doorway.from_m, .to_m = doorway.to_m};
  if (!is_clear_of_ends(door, site)) return std::nullopt;
  door.shuts = from_seconds(random.uniform(1.0, 15.0));
  const Duration shut_for = from_seconds(random.uniform(5.0, 25.0));
  const std::vector<Vec2> leaf_m = across(doorway, site.map.map.resolution_m);
  const bool may_stay = way_of(site, overlaid(with_things(site.map.map, things), leaf_m)).has_value();
  if (!may_stay || random.uniform() < 0.5) door.opens = door.shuts + shut_for;
  return door;
}

}  // namespace lodestar
