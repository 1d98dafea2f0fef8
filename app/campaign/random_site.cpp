#include "app/campaign/random_site.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "app/navigation/navigation_setup.hpp"
#include "maps/random.hpp"
#include "planning/collision_checker.hpp"
#include "planning/margin_planner.hpp"

namespace lodestar {
namespace {

enum SitePurpose : std::uint64_t { walls = 1, furniture, markers, places };

constexpr double resolution_m = 0.05;
constexpr int wall_cells = 2;
constexpr double smallest_room_m = 2.4;
constexpr double ceiling_m = 2.6;
constexpr double shortest_way_m = 2.5;
constexpr double longest_way_m = 8.0;

int cells(double length_m) {
  return static_cast<int>(std::lround(length_m / resolution_m));
}

/// Cells from low (included) to high (excluded).
struct Area {
  Cell low;
  Cell high;
  [[nodiscard]] int width() const { return high.column - low.column; }
  [[nodiscard]] int height() const { return high.row - low.row; }
};

void fill(OccupancyMap& map, const Area& area, std::int8_t value) {
  for (int row = std::max(0, area.low.row); row < std::min(map.rows, area.high.row); ++row) {
    for (int column = std::max(0, area.low.column); column < std::min(map.columns, area.high.column);
         ++column)
      map.cells[map.index({column, row})] = value;
  }
}

Area transposed(const Area& area) {
  return {{area.low.row, area.low.column}, {area.high.row, area.high.column}};
}

/// Divides the area across its longer side by a wall with a door, then both halves in turn.
void divide(OccupancyMap& map, const Area& area, Random& random, std::vector<Area>& rooms) {
  const bool is_wide = area.width() >= area.height();
  const Area along = is_wide ? area : transposed(area);
  const int least = cells(smallest_room_m);
  if (along.width() < 2 * least + wall_cells || (rooms.size() > 1 && random.uniform() < 0.15)) {
    rooms.push_back(area);
    return;
  }
  const int wall = along.low.column + least +
                   static_cast<int>(random.below(static_cast<std::uint64_t>(along.width() - 2 * least)));
  const int door = cells(random.uniform(0.95, 1.4));
  const int room_for_door = along.height() - door - 2 * cells(0.15);
  const int door_at = along.low.row + cells(0.15) +
                      static_cast<int>(random.below(static_cast<std::uint64_t>(std::max(1, room_for_door))));
  const auto oriented = [&](const Area& part) { return is_wide ? part : transposed(part); };
  const int end = wall + wall_cells;
  fill(map, oriented({{wall, along.low.row}, {end, along.high.row}}), OccupancyMap::occupied);
  fill(map, oriented({{wall, door_at}, {end, door_at + door}}), OccupancyMap::free);
  divide(map, oriented({along.low, {wall, along.high.row}}), random, rooms);
  divide(map, oriented({{end, along.low.row}, along.high}), random, rooms);
}

OccupancyMap draw_building(Random random, Random of_furniture) {
  OccupancyMap map;
  map.resolution_m = resolution_m;
  map.columns = cells(random.uniform(7.0, 13.0));
  map.rows = cells(random.uniform(5.0, 8.0));
  map.cells.assign(static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows),
                   OccupancyMap::occupied);
  const Area inside{{wall_cells, wall_cells}, {map.columns - wall_cells, map.rows - wall_cells}};
  fill(map, inside, OccupancyMap::free);
  std::vector<Area> rooms;
  divide(map, inside, random, rooms);
  for (const Area& room : rooms) {
    if (of_furniture.uniform() < 0.4) continue;
    const Cell size{cells(of_furniture.uniform(0.3, 0.9)), cells(of_furniture.uniform(0.3, 0.9))};
    const auto at = [&](int low, int length) {
      return low + static_cast<int>(of_furniture.below(static_cast<std::uint64_t>(std::max(1, length))));
    };
    const Cell low{at(room.low.column, room.width() - size.column),
                   at(room.low.row, room.height() - size.row)};
    fill(map, {low, {low.column + size.column, low.row + size.row}}, OccupancyMap::occupied);
  }
  return map;
}

MarkerRegistry ceiling_of(const OccupancyMap& map, const std::vector<int>& ids, Random random) {
  std::vector<int> left = ids;
  MarkerRegistry registry;
  const double spacing_m = random.uniform(1.5, 2.1);
  constexpr double jitter_m = 0.2;
  for (double y = 0.5 * spacing_m; y < map.rows * resolution_m; y += spacing_m) {
    for (double x = 0.5 * spacing_m; x < map.columns * resolution_m && !left.empty(); x += spacing_m) {
      const auto chosen = left.begin() + static_cast<std::ptrdiff_t>(random.below(left.size()));
      registry.markers.push_back({.id = *chosen,
                                  .position_m = {x + random.uniform(-jitter_m, jitter_m),
                                                 y + random.uniform(-jitter_m, jitter_m), ceiling_m},
                                  .yaw_rad = random.uniform(-std::numbers::pi, std::numbers::pi)});
      left.erase(chosen);
    }
  }
  return registry;
}

Pose2 random_pose(const OccupancyMap& map, const CollisionChecker& clear, Random& random) {
  while (true) {
    const Cell cell{static_cast<int>(random.below(static_cast<std::uint64_t>(map.columns))),
                    static_cast<int>(random.below(static_cast<std::uint64_t>(map.rows)))};
    const double yaw_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
    if (clear.at(cell)) return {map.center_of(cell), yaw_rad};
  }
}

/// Sets a start and a goal; false when all tries were too near, too far or walled off.
bool set_start_and_goal(Site& site, Random random) {
  constexpr int tries = 60;
  const OccupancyMap& map = site.map.map;
  const CollisionChecker clear(map, site.robot.radius_m + 0.1);
  if (std::ranges::none_of(map.cells, is_drivable)) return false;
  const MarginPlanner planner(map, navigation_options(site.robot).planner);
  for (int i = 0; i < tries; ++i) {
    const Pose2 start = random_pose(map, clear, random);
    const Pose2 goal = random_pose(map, clear, random);
    const double apart_m = (goal.position_m - start.position_m).norm();
    if (apart_m < shortest_way_m || apart_m > longest_way_m) continue;
    const PlanResult result = planner.plan(start.position_m, goal.position_m);
    const auto* plan = std::get_if<Plan>(&result);
    if (plan == nullptr || length_m(plan->path) > longest_way_m) continue;
    site.start = start;
    site.goals = {{goal.position_m, goal.yaw_rad}};
    return true;
  }
  return false;
}

}  // namespace

Site random_site(const Site& robot_and_cameras, const std::vector<int>& ids, std::uint64_t seed) {
  Site site = robot_and_cameras;
  for (std::uint64_t attempt = 0;; ++attempt) {
    const Random random = Random(seed).stream(attempt);
    site.map.map = draw_building(random.stream(walls), random.stream(furniture));
    if (set_start_and_goal(site, random.stream(places))) {
      site.registry = ceiling_of(site.map.map, ids, random.stream(markers));
      return site;
    }
  }
}

}  // namespace lodestar
