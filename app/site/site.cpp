#include "app/site/site.hpp"

#include <fmt/format.h>

#include "maps/input_error.hpp"
#include "maps/strict_yaml.hpp"

namespace lodestar {
namespace {

void expect_format(StrictYaml& yaml, const std::string& format) {
  const std::string found = yaml.text("format");
  if (found != format) yaml.refuse("format", "'" + found + "'", "'" + format + "'");
  (void)yaml.integer("version", 1, 1);
}

Vec2 read_position(StrictYaml& yaml) {
  const double x_m = yaml.number("x_m", -far_m, far_m);
  const double y_m = yaml.number("y_m", -far_m, far_m);
  return {x_m, y_m};
}

double read_angle(StrictYaml& yaml, const std::string& key) {
  return radians(yaml.number(key, -360.0, 360.0));
}

Pose2 read_start(StrictYaml yaml) {
  const Pose2 start{read_position(yaml), wrap_angle(read_angle(yaml, "yaw_deg"))};
  yaml.finish();
  return start;
}

Goal read_goal(StrictYaml& yaml) {
  Goal goal{read_position(yaml), std::nullopt};
  if (yaml.has("yaw_deg")) goal.heading_rad = wrap_angle(read_angle(yaml, "yaw_deg"));
  if (yaml.has("name")) (void)yaml.text("name");
  yaml.finish();
  return goal;
}

void read_mount(StrictYaml yaml, Robot& robot) {
  const double x_m = yaml.number("x_m", -10.0, 10.0);
  const double y_m = yaml.number("y_m", -10.0, 10.0);
  const double z_m = yaml.number("z_m", 0.0, 10.0);
  robot.camera_mount = {yaml.number("roll_deg", -45.0, 45.0), yaml.number("pitch_deg", -45.0, 45.0),
                        read_angle(yaml, "yaw_deg")};
  robot.camera_mount.roll_rad = radians(robot.camera_mount.roll_rad);
  robot.camera_mount.pitch_rad = radians(robot.camera_mount.pitch_rad);
  robot.base_from_camera.linear() = rotation_from(robot.camera_mount);
  robot.base_from_camera.translation() << x_m, y_m, z_m;
  yaml.finish();
}

/// Pairs of x and y; errors of the polygon name its line.
Footprint read_footprint(StrictYaml& yaml) {
  const std::string key = "footprint_m";
  const std::vector<Vec2> corners_m = yaml.points(key, 10.0);
  try {
    return Footprint(corners_m);
  } catch (const InputError&) {
    yaml.refuse(key, fmt::format("{} corners that make none", corners_m.size()),
                "a polygon that goes around once, counter-clockwise, without touching itself");
  }
}

void read_limits(StrictYaml yaml, Robot& robot) {
  robot.max_forward_mps = yaml.number("max_forward_mps", 0.01, 5.0);
  robot.max_turn_radps = yaml.number("max_turn_radps", 0.01, 10.0);
  robot.max_acceleration_mps2 = yaml.number("max_acceleration_mps2", 0.01, 10.0);
  robot.max_turn_acceleration_radps2 = yaml.number("max_turn_acceleration_radps2", 0.01, 30.0);
  robot.max_wheel_mps = yaml.number("max_wheel_mps", 0.01, 5.0);
  yaml.finish();
}

/// A dead band wider than the limit would leave no speed to drive at.
void read_motors(StrictYaml yaml, Robot& robot) {
  if (yaml.has("response_s")) robot.response_s = yaml.number("response_s", 0.0, 2.0);
  if (yaml.has("dead_band_mps"))
    robot.dead_band_mps = yaml.number("dead_band_mps", 0.0, robot.max_forward_mps);
  if (yaml.has("dead_band_radps"))
    robot.dead_band_radps = yaml.number("dead_band_radps", 0.0, robot.max_turn_radps);
  yaml.finish();
}

void read_wheels(StrictYaml yaml, Robot& robot) {
  if (yaml.has("encoder_step_m")) robot.encoder_step_m = yaml.number("encoder_step_m", 0.0, 0.05);
  if (yaml.has("noise_m_per_sqrt_m"))
    robot.wheel_noise_m_per_sqrt_m = yaml.number("noise_m_per_sqrt_m", 1e-5, 0.1);
  yaml.finish();
}

void read_arrival(StrictYaml yaml, Robot& robot) {
  robot.arrival_distance_m = yaml.number("distance_m", 0.001, 1.0);
  robot.arrival_heading_rad = radians(yaml.number("heading_deg", 0.1, 90.0));
  yaml.finish();
}

/// "socketcan:can0".
BaseConnection read_base(StrictYaml yaml) {
  const std::string bus = yaml.text("bus");
  const std::string driver = "socketcan:";
  if (!bus.starts_with(driver) || bus.size() == driver.size()) {
    yaml.refuse("bus", "'" + bus + "'", "'socketcan:' and the name of an interface");
  }
  BaseConnection base;
  base.interface = bus.substr(driver.size());
  base.protocol = yaml.text("protocol");
  if (base.protocol != "agilex" && base.protocol != "odrive") {
    yaml.refuse("protocol", "'" + base.protocol + "'", "agilex or odrive");
  }
  if (base.protocol == "agilex" && yaml.has("model")) {
    base.model = yaml.text("model");
    const bool is_known = base.model == "tracer" || base.model == "scout" || base.model == "hunter";
    if (!is_known) yaml.refuse("model", "'" + base.model + "'", "tracer, scout or hunter");
  }
  if (base.protocol == "odrive") {
    base.wheel_diameter_m = yaml.number("wheel_diameter_m", 0.01, 2.0);
    base.left_node = yaml.integer("left_node", 0, 63);
    base.right_node = yaml.integer("right_node", 0, 63);
    base.right_is_mirrored = yaml.boolean("right_is_mirrored");
  }
  yaml.finish();
  return base;
}

}  // namespace

Robot load_robot(const std::filesystem::path& file) {
  StrictYaml yaml = StrictYaml::load(file);
  expect_format(yaml, "lodestar-robot");
  Robot robot;
  robot.name = yaml.text("name");
  robot.radius_m = yaml.number("radius_m", 0.01, 5.0);
  if (yaml.has("footprint_m")) robot.footprint = read_footprint(yaml);
  robot.track_width_m = yaml.number("track_width_m", 0.01, 5.0);
  read_mount(yaml.mapping("camera_mount"), robot);
  robot.mount_tilt_sigma_rad = radians(yaml.number("mount_tilt_sigma_deg", 0.0, 20.0));
  robot.mount_height_sigma_m = yaml.number("mount_height_sigma_m", 1e-6, 1.0);
  if (yaml.has("shared_fix_sigma_m")) robot.shared_fix_sigma_m = yaml.number("shared_fix_sigma_m", 0.0, 1.0);
  if (yaml.has("shared_fix_sigma_deg"))
    robot.shared_fix_sigma_rad = radians(yaml.number("shared_fix_sigma_deg", 0.0, 20.0));
  read_limits(yaml.mapping("limits"), robot);
  read_arrival(yaml.mapping("arrival"), robot);
  if (yaml.has("motors")) read_motors(yaml.mapping("motors"), robot);
  if (yaml.has("wheels")) read_wheels(yaml.mapping("wheels"), robot);
  robot.preferred_clearance_m = yaml.number("preferred_clearance_m", 0.0, 5.0);
  if (yaml.has("pass_corners_within_m"))
    robot.pass_corners_within_m = yaml.number("pass_corners_within_m", 0.0, 1.0);
  yaml.finish();
  return robot;
}

Site load_site(const std::filesystem::path& folder) {
  StrictYaml yaml = StrictYaml::load(folder / "site.yaml");
  expect_format(yaml, "lodestar-site");
  Site site;
  site.folder = folder;
  site.name = yaml.text("name");
  site.map = load_map(folder / yaml.text("map"));
  if (yaml.has("octomap")) site.octomap_file = folder / yaml.text("octomap");
  site.registry_file = folder / yaml.text("markers");
  site.registry = load_registry(site.registry_file);
  StrictYaml cameras = yaml.mapping("cameras");
  for (const std::string profile : {"wide", "paper"}) {
    if (cameras.has(profile)) site.cameras.emplace(profile, load_camera(folder / cameras.text(profile)));
  }
  cameras.finish();
  site.default_camera = yaml.text("default_camera");
  if (!site.cameras.contains(site.default_camera)) {
    yaml.refuse("default_camera", "'" + site.default_camera + "'", "one of the keys of cameras");
  }
  site.robot_file = folder / yaml.text("robot");
  site.robot = load_robot(site.robot_file);
  site.start = read_start(yaml.mapping("start"));
  for (StrictYaml& goal : yaml.list_of_mappings("goals")) site.goals.push_back(read_goal(goal));
  if (site.goals.empty()) yaml.refuse("goals", "an empty list", "at least one goal");
  if (yaml.has("camera")) site.camera = yaml.text("camera");
  if (yaml.has("base")) site.base = read_base(yaml.mapping("base"));
  yaml.finish();
  return site;
}

}  // namespace lodestar
