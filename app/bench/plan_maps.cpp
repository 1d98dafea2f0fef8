#include "app/bench/plan_maps.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "maps/random.hpp"

namespace lodestar {
namespace {

constexpr double depth_m = 6.0;  ///< of a room
constexpr double corridor_m = 2.0;
constexpr double band_m = 2.0 * depth_m + corridor_m;  ///< a corridor with rooms on both sides

OccupancyMap empty_map(double size_m, double resolution_m) {
  OccupancyMap map;
  map.columns = map.rows = static_cast<int>(std::lround(size_m / resolution_m));
  map.resolution_m = resolution_m;
  map.cells.assign(static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows),
                   OccupancyMap::free);
  return map;
}

/// Paints in the frame of the building, which is rotated about the middle of the map.
class Painter {
 public:
  Painter(OccupancyMap& map, Random random)
      : map_(map),
        random_(random),
        middle_m_(0.5 * map.columns * map.resolution_m, 0.5 * map.rows * map.resolution_m) {}

  void wall(const Vec2& from_m, const Vec2& to_m) {
    constexpr double thickness_m = 0.12;
    constexpr double jitter_m = 0.015;
    const double length_m = (to_m - from_m).norm();
    const Vec2 along = (to_m - from_m).normalized();
    const Vec2 across(-along.y(), along.x());
    for (double at_m = 0.0; at_m <= length_m; at_m += 0.5 * map_.resolution_m) {
      const double aside_m = jitter_m * random_.normal();
      const double thick_m = 0.5 * thickness_m + 0.5 * jitter_m * random_.normal();
      stamp(from_m + at_m * along + aside_m * across, thick_m);
    }
  }

  /// A desk: its outline, as a scanner sees it.
  void desk(const Vec2& low_m, const Vec2& size_m) {
    const Vec2 high_m = low_m + size_m;
    wall(low_m, {high_m.x(), low_m.y()});
    wall({high_m.x(), low_m.y()}, high_m);
    wall(high_m, {low_m.x(), high_m.y()});
    wall({low_m.x(), high_m.y()}, low_m);
  }

 private:
  void stamp(const Vec2& place_m, double radius_m) {
    static const double angle_rad = 3.0 / 180.0 * std::numbers::pi;
    const Vec2 from_middle_m = place_m - middle_m_;
    const Vec2 at =
        (middle_m_ +
         Vec2(std::cos(angle_rad) * from_middle_m.x() - std::sin(angle_rad) * from_middle_m.y(),
              std::sin(angle_rad) * from_middle_m.x() + std::cos(angle_rad) * from_middle_m.y())) /
        map_.resolution_m;
    const double reach = std::max(radius_m / map_.resolution_m, 0.5);
    const Cell low = cell_at(at - Vec2::Constant(reach));
    const Cell high = cell_at(at + Vec2::Constant(reach));
    for (int row = low.row; row <= high.row; ++row)
      for (int column = low.column; column <= high.column; ++column) {
        const Cell cell{column, row};
        if (map_.contains(cell) && (center_of(cell) - at).norm() <= reach)
          map_.cells[map_.index(cell)] = OccupancyMap::occupied;
      }
  }

  OccupancyMap& map_;
  Random random_;
  Vec2 middle_m_;
};

/// A wall along x from one place to another with a door of random width at a random place, if it is long
/// enough.
void wall_with_door(Painter& painter, Random& random, double from_m, double to_m, double y_m) {
  const double door_m = random.uniform(0.95, 1.2);
  const double at_m = from_m + 0.2 + random.uniform() * (to_m - from_m - door_m - 0.4);
  if (to_m - from_m < door_m + 0.4) return painter.wall({from_m, y_m}, {to_m, y_m});
  painter.wall({from_m, y_m}, {at_m, y_m});
  painter.wall({at_m + door_m, y_m}, {to_m, y_m});
}

void furnish(Painter& painter, Random& random, const Vec2& low_m, const Vec2& high_m) {
  const auto desks = random.below(4);
  for (std::uint64_t i = 0; i < desks; ++i) {
    const bool upright = random.uniform() < 0.5;
    const Vec2 size_m = upright ? Vec2(0.7, 1.4) : Vec2(1.4, 0.7);
    const Vec2 room_m = high_m - low_m - size_m - Vec2::Constant(0.6);
    const double x = random.uniform();
    const double y = random.uniform();
    if (room_m.minCoeff() > 0.0)
      painter.desk(low_m + Vec2::Constant(0.3) + Vec2(x * room_m.x(), y * room_m.y()), size_m);
  }
}

/// A row of rooms between two corridors across, with doors to the corridor at `door_y_m`.
void row_of_rooms(Painter& painter, Random& random, const Vec2& low_m, double to_x_m, double door_y_m) {
  for (double x_m = low_m.x(); x_m < to_x_m;) {
    double end_m = x_m + random.uniform(3.0, 7.0);
    if (to_x_m - end_m < 3.0) end_m = to_x_m;
    painter.wall({x_m, low_m.y()}, {x_m, low_m.y() + depth_m});
    wall_with_door(painter, random, x_m, end_m, door_y_m);
    furnish(painter, random, {x_m, low_m.y()}, {end_m, low_m.y() + depth_m});
    x_m = end_m;
  }
  painter.wall({to_x_m, low_m.y()}, {to_x_m, low_m.y() + depth_m});
}

struct Generated {
  std::string_view name;
  OccupancyMap (*draw)(std::uint64_t seed);
};
constexpr std::array<Generated, 6> generated{{
    {"offices-5cm", [](std::uint64_t seed) { return ragged_offices(60.0, 0.05, seed); }},
    {"offices-3cm", [](std::uint64_t seed) { return ragged_offices(60.0, 0.03, seed); }},
    {"offices-2cm", [](std::uint64_t seed) { return ragged_offices(60.0, 0.02, seed); }},
    {"offices-80m-2cm", [](std::uint64_t seed) { return ragged_offices(80.0, 0.02, seed); }},
    {"posts-2000", [](std::uint64_t seed) { return scattered_posts(40.0, 0.05, 2000, seed); }},
    {"posts-6000", [](std::uint64_t seed) { return scattered_posts(40.0, 0.05, 6000, seed); }},
}};

}  // namespace

OccupancyMap ragged_offices(double size_m, double resolution_m, std::uint64_t seed) {
  OccupancyMap map = empty_map(size_m, resolution_m);
  Random random(seed);
  Painter painter(map, random.stream(1));
  constexpr double outside_m = 2.5;  // so that the rotated building fits
  const double begin_m = outside_m;
  const double end_m = size_m - outside_m;
  const double wing_m = (end_m - begin_m - 2.0 * corridor_m) / 3.0;  // two corridors across
  double y_m = begin_m;
  for (; y_m + band_m <= end_m; y_m += band_m) {
    for (int wing = 0; wing < 3; ++wing) {
      const double x_m = begin_m + wing * (wing_m + corridor_m);
      painter.wall({x_m, y_m}, {x_m + wing_m, y_m});
      row_of_rooms(painter, random, {x_m, y_m}, x_m + wing_m, y_m + depth_m);
      row_of_rooms(painter, random, {x_m, y_m + depth_m + corridor_m}, x_m + wing_m,
                   y_m + depth_m + corridor_m);
    }
  }
  painter.wall({begin_m, begin_m}, {end_m, begin_m});
  painter.wall({begin_m, y_m}, {end_m, y_m});
  painter.wall({begin_m, begin_m}, {begin_m, y_m});
  painter.wall({end_m, begin_m}, {end_m, y_m});
  return map;
}

OccupancyMap scattered_posts(double size_m, double resolution_m, int posts, std::uint64_t seed) {
  OccupancyMap map = empty_map(size_m, resolution_m);
  Random random(seed);
  for (int i = 0; i < posts; ++i) map.cells[random.below(map.cells.size())] = OccupancyMap::occupied;
  return map;
}

std::optional<OccupancyMap> generated_map(std::string_view name, std::uint64_t seed) {
  const auto* found = std::ranges::find(generated, name, &Generated::name);
  if (found == generated.end()) return std::nullopt;
  return found->draw(seed);
}

std::vector<std::string> generated_map_names() {
  std::vector<std::string> names;
  for (const Generated& each : generated) names.emplace_back(each.name);
  return names;
}

}  // namespace lodestar
