#include "app/placement/installation.hpp"

#include <cmath>
#include <fmt/format.h>

#include "app/placement/registry_check.hpp"

namespace lodestar {
namespace {

/// In cells, from a point to the first wall's face along one axis.
std::optional<double> to_wall(const OccupancyMap& map, const Vec2& from, Cell step) {
  Cell cell = cell_at(from);
  if (map.contains(cell) && map.at(cell) >= 50) return std::nullopt;
  for (; map.contains(cell); cell = {cell.column + step.column, cell.row + step.row}) {
    if (map.at(cell) < 50) continue;
    const Vec2 face = center_of(cell) - 0.5 * Vec2(step.column, step.row);
    return step.column != 0 ? std::abs(face.x() - from.x()) : std::abs(face.y() - from.y());
  }
  return std::nullopt;
}

/// "left,1.250", or ",".
std::string csv_of(const std::optional<NearerWall>& wall) {
  return wall ? fmt::format("{},{:.3f}", wall->side, wall->distance_m) : ",";
}

/// Of RFC 4180.
std::string quoted(const std::string& words) {
  if (words.find_first_of(",\"\n\r") == std::string::npos) return words;
  std::string text = "\"";
  for (const char c : words) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

}  // namespace

std::optional<NearerWall> nearer_wall(const std::string& low, const std::optional<double>& low_m,
                                      const std::string& high, const std::optional<double>& high_m) {
  if (!low_m && !high_m) return std::nullopt;
  const bool is_low = low_m && (!high_m || *low_m <= *high_m);
  return NearerWall{is_low ? low : high, is_low ? *low_m : *high_m};
}

WallDistances wall_distances(const OccupancyMap& map, const Vec2& center_in_map_m) {
  const Vec2 from = (inverse(map.map_from_grid) * center_in_map_m) / map.resolution_m;
  const auto metres = [&](Cell step) -> std::optional<double> {
    const std::optional<double> cells = to_wall(map, from, step);
    if (!cells) return std::nullopt;
    return *cells * map.resolution_m;
  };
  return {metres({-1, 0}), metres({1, 0}), metres({0, -1}), metres({0, 1})};
}

std::string installation_csv(const MarkerRegistry& registry, const OccupancyMap& map, const std::string& site,
                             const std::string& date) {
  std::string text = "id,x_m,y_m,z_m,yaw_deg,wall_x,wall_x_m,wall_y,wall_y_m,face,site,date\n";
  for (const RegisteredMarker& marker : registry.markers) {
    const Vec3 center_m = center_in_map(registry, marker);
    const WallDistances walls = wall_distances(map, center_m.head<2>());
    const double yaw_rad = flattened(map_from_marker(registry, marker)).yaw_rad;
    text += fmt::format(
        "{},{:.3f},{:.3f},{:.3f},{:.1f},{},{},down,{},{}\n", marker.id, center_m.x(), center_m.y(),
        center_m.z(), degrees(yaw_rad), csv_of(nearer_wall("left", walls.left_m, "right", walls.right_m)),
        csv_of(nearer_wall("below", walls.below_m, "above", walls.above_m)), quoted(site), quoted(date));
  }
  return text;
}

}  // namespace lodestar
