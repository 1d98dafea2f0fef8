#include "app/simulate/scenario_file.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "app/simulate/marker_grid_above.hpp"
#include "maps/strict_yaml.hpp"

namespace lodestar {
namespace {

constexpr double longest_s = 1e6;  // 11 days

OccupancyMap empty_hall(double width_m, double height_m) {
  OccupancyMap map;
  map.resolution_m = 0.05;
  // A part of a cell at the far edge is left out: outside of the hall nothing is free.
  map.columns = static_cast<int>(std::floor(width_m / map.resolution_m + 1e-6));
  map.rows = static_cast<int>(std::floor(height_m / map.resolution_m + 1e-6));
  map.cells.assign(static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows),
                   OccupancyMap::free);
  return map;
}

LoadedMap read_world(StrictYaml& yaml) {
  const bool has_map = yaml.has("map");
  if (has_map && yaml.has("size_m")) yaml.refuse("size_m", "a size besides a map", "one of them");
  if (has_map) return load_map(yaml.file().parent_path() / yaml.text("map"));
  const std::vector<double> size_m = yaml.numbers("size_m", 2);
  for (const double side_m : size_m)
    if (side_m < 0.5 || side_m > 500.0) yaml.refuse("size_m", fmt::format("{} m", side_m), "0.5 to 500 m");
  LoadedMap hall;
  hall.map = empty_hall(size_m[0], size_m[1]);
  return hall;
}

Vec2 read_place(StrictYaml& yaml) {
  const double x_m = yaml.number("x_m", -far_m, far_m);
  const double y_m = yaml.number("y_m", -far_m, far_m);
  return {x_m, y_m};
}

Pose2 read_start(StrictYaml yaml) {
  const Pose2 start{read_place(yaml), wrap_angle(radians(yaml.number("yaw_deg", -360.0, 360.0)))};
  yaml.finish();
  return start;
}

void read_goal(StrictYaml yaml, Scenario& scenario) {
  scenario.site.goals = {{read_place(yaml), std::nullopt}};
  scenario.goal_radius_m = yaml.number("radius_m", 0.001, 100.0);
  yaml.finish();
}

/// The ranges of robot.yaml; each key that is given replaces the robot's.
void read_limits(StrictYaml yaml, Robot& robot) {
  const auto replace = [&](const char* key, double most, double& limit) {
    if (yaml.has(key)) limit = yaml.number(key, 0.01, most);
  };
  replace("max_forward_mps", 5.0, robot.max_forward_mps);
  replace("max_turn_radps", 10.0, robot.max_turn_radps);
  replace("max_acceleration_mps2", 10.0, robot.max_acceleration_mps2);
  replace("max_turn_acceleration_radps2", 30.0, robot.max_turn_acceleration_radps2);
  replace("max_wheel_mps", 5.0, robot.max_wheel_mps);
  yaml.finish();
}

void read_scanner(StrictYaml yaml, SimulatedScannerOptions& scanner) {
  if (yaml.has("rate_hz")) scanner.rate_hz = yaml.number("rate_hz", 0.5, 200.0);
  if (yaml.has("beams")) scanner.beams = yaml.integer("beams", 8, 100'000);
  if (yaml.has("range_m")) scanner.range_m = yaml.number("range_m", 0.5, 200.0);
  if (yaml.has("delay_s")) scanner.delay = from_seconds(yaml.number("delay_s", 0.0, 2.0));
  yaml.finish();
}

std::vector<DiscKey> read_keys(StrictYaml& yaml) {
  const std::string key = "keys";
  const std::string wanted = "a list of [t_s, x_m, y_m], their times ascending from 0 on";
  const YAML::Node list = yaml.node(key);
  if (!list.IsSequence() || list.size() == 0) yaml.refuse(key, "something else or an empty list", wanted);
  std::vector<DiscKey> keys;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::vector<double> numbers = yaml.numbers_at(key, list[i], 3);
    const DiscKey next{from_seconds(std::clamp(numbers[0], 0.0, longest_s)), {numbers[1], numbers[2]}};
    const bool is_in_range =
        numbers[0] >= 0.0 && numbers[0] <= longest_s && next.position_m.cwiseAbs().maxCoeff() <= far_m;
    if (!is_in_range || (!keys.empty() && next.time <= keys.back().time))
      yaml.refuse_at(list[i], fmt::format("[{}, {}, {}]", numbers[0], numbers[1], numbers[2]), wanted);
    keys.push_back(next);
  }
  return keys;
}

MovingDisc read_disc(StrictYaml& yaml) {
  MovingDisc disc;
  disc.radius_m = yaml.number("radius_m", 0.001, 50.0);
  if (yaml.has("legs")) disc.has_legs = yaml.boolean("legs");
  disc.trajectory.keys = read_keys(yaml);
  if (yaml.has("loop")) disc.trajectory.loops = yaml.boolean("loop");
  yaml.finish();
  return disc;
}

Overhang read_overhang(StrictYaml& yaml) {
  const auto range = [&](const char* key, double least, double most) {
    const std::vector<double> ends = yaml.numbers(key, 2);
    if (ends[0] >= ends[1] || ends[0] < least || ends[1] > most)
      yaml.refuse(key, fmt::format("[{}, {}]", ends[0], ends[1]),
                  fmt::format("[LOW, HIGH] between {} and {}", least, most));
    return Vec2(ends[0], ends[1]);
  };
  const Vec2 x_m = range("x_m", -far_m, far_m);
  const Vec2 y_m = range("y_m", -far_m, far_m);
  const Vec2 z_m = range("z_m", 0.0, 10.0);
  yaml.finish();
  return {.low_m = {x_m[0], y_m[0]}, .high_m = {x_m[1], y_m[1]}, .bottom_m = z_m[0], .top_m = z_m[1]};
}

bool markers_hang(StrictYaml& yaml) {
  if (!yaml.has("markers")) return true;
  const std::string markers = yaml.text("markers");
  if (markers != "hang" && markers != "none") yaml.refuse("markers", "'" + markers + "'", "hang or none");
  return markers == "hang";
}

}  // namespace

Scenario load_scenario(const std::filesystem::path& file, const Site& lab) {
  StrictYaml yaml = StrictYaml::load(file);
  const std::string format = yaml.text("format");
  if (format != "lodestar-scenario") yaml.refuse("format", "'" + format + "'", "'lodestar-scenario'");
  (void)yaml.integer("version", 1, 1);

  Scenario scenario;
  Site& site = scenario.site;
  site.name = file.stem().string();
  site.folder = file.parent_path();
  site.map = read_world(yaml);
  site.cameras = lab.cameras;
  site.default_camera = lab.default_camera;
  site.start = read_start(yaml.mapping("start"));
  read_goal(yaml.mapping("goal"), scenario);
  scenario.time_limit_s = yaml.number("time_limit_s", 0.1, longest_s);

  const bool has_robot = yaml.has("robot");
  site.robot_file = has_robot ? site.folder / yaml.text("robot") : lab.robot_file;
  site.robot = has_robot ? load_robot(site.robot_file) : lab.robot;
  if (yaml.has("limits")) read_limits(yaml.mapping("limits"), site.robot);
  if (!site.robot.scanner) site.robot.scanner.emplace();
  scenario.scanner.mount = site.robot.scanner->mount;
  if (yaml.has("scanner")) read_scanner(yaml.mapping("scanner"), scenario.scanner);
  if (yaml.has("discs"))
    for (StrictYaml& disc : yaml.list_of_mappings("discs")) scenario.discs.push_back(read_disc(disc));
  if (yaml.has("overhangs"))
    for (StrictYaml& overhang : yaml.list_of_mappings("overhangs"))
      scenario.overhangs.push_back(read_overhang(overhang));
  scenario.is_placed_at_start = !markers_hang(yaml);
  yaml.finish();
  if (!scenario.is_placed_at_start) site.registry = marker_grid_above(site.map.map);
  return scenario;
}

}  // namespace lodestar
