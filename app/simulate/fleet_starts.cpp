#include "app/simulate/fleet_starts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <queue>

#include "app/navigation/navigation_setup.hpp"
#include "app/placement/visibility.hpp"
#include "maps/input_error.hpp"
#include "maps/obstacle_field.hpp"

namespace lodestar {
namespace {

/// Beside the robot, so that it can turn and leave. Chosen by hand.
constexpr double beside_m = 0.1;

/// Cells where the robot has room and to which it can drive, nearest first.
std::vector<Cell> reachable_cells(const ObstacleField& field, const Vec2& from_m, double room_m) {
  const OccupancyMap& map = field.map();
  std::vector<bool> is_seen(map.cells.size(), false);
  std::vector<Cell> reached;
  std::queue<Cell> open;
  const auto visit = [&](Cell cell) {
    if (!map.contains(cell) || is_seen[map.index(cell)]) return;
    is_seen[map.index(cell)] = true;
    if (field.distance_cells(map.index(cell)) * map.resolution_m > room_m) open.push(cell);
  };
  visit(map.cell_at(from_m));
  while (!open.empty()) {
    const Cell cell = open.front();
    open.pop();
    reached.push_back(cell);
    for (const auto& [column, row] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
      visit({cell.column + column, cell.row + row});
  }
  return reached;
}

}  // namespace

std::vector<Pose2> fleet_starts(const Site& site, const std::string& camera, int robots, double apart_m) {
  const KnownWorld world = known_world(site, camera);
  const ObstacleField field(drivable_map(site));
  const OccupancyMap& map = field.map();
  VisibilityOptions options = visibility_options(site.robot);
  options.stride = std::max(1, static_cast<int>(site.robot.radius_m / map.resolution_m));
  const Visibility visibility = visibility_of(map, site.registry, world.camera, nullptr, options);
  std::vector<Pose2> starts{site.start};
  const double room_m = site.robot.radius_m + beside_m;
  for (const Cell cell : reachable_cells(field, site.start.position_m, room_m)) {
    if (starts.size() >= static_cast<std::size_t>(robots)) break;
    const std::optional<CellView>& view = visibility.cells[map.index(cell)];
    const Vec2 place_m = map.center_of(cell);
    const bool is_apart = std::ranges::all_of(
        starts, [&](const Pose2& other) { return (other.position_m - place_m).norm() >= apart_m; });
    if (view && view->least > 0 && is_apart) starts.push_back({place_m, site.start.yaw_rad});
  }
  if (starts.size() < static_cast<std::size_t>(robots))
    throw InputError(
        fmt::format("found room for {} robots at {}, wanted {}", starts.size(), site.name, robots));
  return starts;
}

}  // namespace lodestar
