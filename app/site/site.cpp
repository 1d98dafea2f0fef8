#include "app/site/site.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fmt/format.h>
#include <set>
#include <utility>

#include "app/site/places_limits.hpp"
#include "app/site/ranging_settings.hpp"
#include "maps/camera_file.hpp"
#include "maps/input_error.hpp"
#include "maps/path_kind.hpp"
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

std::vector<std::string> read_words(StrictYaml& yaml, const std::string& key) {
  const YAML::Node list = yaml.node(key);
  std::vector<std::string> words;
  const bool is_list = list.IsSequence();
  for (std::size_t i = 0; is_list && i < list.size(); ++i) {
    if (list[i].IsScalar()) words.push_back(list[i].Scalar());
  }
  if (!is_list || words.size() != list.size()) yaml.refuse(key, "something else", "a list of words");
  return words;
}

ControlMode read_mode(StrictYaml& yaml, const std::string& key, const std::string& word) {
  constexpr std::array<std::pair<const char*, ControlMode>, 4> modes{{{"standby", ControlMode::standby},
                                                                      {"can", ControlMode::can},
                                                                      {"uart", ControlMode::uart},
                                                                      {"remote", ControlMode::remote}}};
  for (const auto& [name, mode] : modes) {
    if (word == name) return mode;
  }
  yaml.refuse(key, "'" + word + "'", "standby, can, uart or remote");
}

void read_base_settings(StrictYaml yaml, Robot& robot) {
  robot.base.file = yaml.file();
  robot.base.line = yaml.line();
  if (yaml.has("ignored_faults")) robot.base.ignored_faults = read_words(yaml, "ignored_faults");
  if (yaml.has("modes")) {
    const std::vector<std::string> words = read_words(yaml, "modes");
    for (const std::string& word : words) robot.base.modes.push_back(read_mode(yaml, "modes", word));
    if (std::ranges::count(robot.base.modes, ControlMode::can) != 1)
      yaml.refuse("modes", "a list without can, or with two", "one can: the mode to ask for");
  }
  yaml.finish();
}

void read_arrival(StrictYaml yaml, Robot& robot) {
  robot.arrival_distance_m = yaml.number("distance_m", 0.001, 1.0);
  robot.arrival_heading_rad = radians(yaml.number("heading_deg", 0.1, 90.0));
  yaml.finish();
}

/// A machine-vision camera's gain is in decibels, and its own clock stamps.
CameraSettings read_camera_settings(StrictYaml yaml, bool is_machine_vision) {
  constexpr double s_per_ms = 1e-3;
  CameraSettings settings;
  if (yaml.has("exposure_ms")) settings.exposure_s = s_per_ms * yaml.number("exposure_ms", 0.1, 1000.0);
  if (yaml.has("gain"))
    settings.gain = is_machine_vision ? yaml.number("gain", -100.0, 1e6) : yaml.integer("gain", 0, 1'000'000);
  if (yaml.has("rate_hz")) settings.rate_hz = yaml.number("rate_hz", 1.0, 1000.0);
  if (yaml.has("latency_ms")) settings.latency_s = s_per_ms * yaml.number("latency_ms", 0.0, 250.0);
  if (!is_machine_vision && yaml.has("stamped_at")) {
    const std::string moment = yaml.text("stamped_at");
    if (moment != "exposure_start" && moment != "arrival")
      yaml.refuse("stamped_at", "'" + moment + "'", "exposure_start or arrival");
    settings.stamped_at_start = moment == "exposure_start";
  }
  yaml.finish();
  return settings;
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

/// Names of camera profiles are words of the command line and of file names.
void check_name(const StrictYaml::OtherKey& profile, const std::filesystem::path& file) {
  constexpr std::size_t longest = 40;
  const bool is_word = std::ranges::all_of(profile.name, [](unsigned char letter) {
    return (letter < 0x80 && std::isalnum(letter) != 0) || letter == '-' || letter == '_';
  });
  if (is_word && !profile.name.empty() && !profile.name.starts_with('-') && profile.name.size() <= longest)
    return;
  throw InputError(file, profile.line, "the camera profile '" + profile.name + "'",
                   "a name of 1 to 40 letters, digits, '-' and '_'");
}

void check_speed_limits(const Site& site) {
  const std::optional<TooSlow> slow = first_too_slow(site.places, site.robot);
  if (slow) throw InputError(site.folder / places_file_name, 0, slow->found, slow->wanted);
}

ChargingSettings read_charging(StrictYaml yaml, const Site& site) {
  const double slowest_mps = site.robot.dead_band_mps.value_or(0.0);
  const ChargingSettings charging = read_charging_settings(yaml, site.places);
  if (charging.approach_mps < slowest_mps)
    yaml.refuse("approach_mps", fmt::format("{}", charging.approach_mps),
                fmt::format("at least the robot's dead_band_mps, {}", slowest_mps));
  return charging;
}

void check_actions(const Site& site) {
  std::set<std::string> types;
  for (const ActionHook& hook : site.actions) {
    if (!types.insert(hook.type).second)
      throw InputError(site.folder / "site.yaml", 0, "the action " + hook.type + " twice", "each once");
    const bool charges = hook.type == "startCharging" || hook.type == "stopCharging";
    if (site.charging && charges)
      throw InputError(site.folder / "site.yaml", 0, "a program for " + hook.type + " beside charging:",
                       "one of them: with charging: the robot carries that action out itself");
  }
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
  if (yaml.has("scanner")) robot.scanner = read_scanner(yaml.mapping("scanner"));
  if (yaml.has("depth_camera")) {
    if (!robot.scanner)
      yaml.refuse("depth_camera", "one without a scanner",
                  "a scanner too: a depth camera looks one way only");
    robot.depth_camera = read_depth_camera(yaml.mapping("depth_camera"));
  }
  if (yaml.has("base")) read_base_settings(yaml.mapping("base"), robot);
  if (yaml.has("battery")) (void)read_battery_curve(yaml.mapping("battery"));  // kept by who asks for it
  robot.preferred_clearance_m = yaml.number("preferred_clearance_m", 0.0, 5.0);
  if (yaml.has("pass_corners_within_m"))
    robot.pass_corners_within_m = yaml.number("pass_corners_within_m", 0.0, 1.0);
  yaml.finish();
  return robot;
}

std::optional<std::string> unknown_action(const Places& places, const Site& site) {
  for (const NamedMission& mission : places.missions) {
    for (const MissionStop& stop : mission.stops) {
      const bool is_known = stop.action.empty() || std::ranges::find(site.actions, stop.action,
                                                                     &ActionHook::type) != site.actions.end();
      if (!is_known) return "the action '" + stop.action + "' in mission '" + mission.name + "'";
    }
  }
  return std::nullopt;
}

Site load_site(const std::filesystem::path& folder) {
  if (is_folder(folder) && !is_file(folder / "site.yaml")) {
    throw InputError(
        folder, 0, "no site.yaml",
        "a site folder; `lodestar site new PLAN_OR_MAP -o FOLDER` makes one from a plan or a map");
  }
  StrictYaml yaml = StrictYaml::load(folder / "site.yaml");
  expect_format(yaml, "lodestar-site");
  Site site;
  site.folder = folder;
  site.name = yaml.text("name");
  site.map_file = folder / yaml.text("map");
  site.map = load_map(site.map_file);
  if (yaml.has("octomap")) site.octomap_file = folder / yaml.text("octomap");
  site.registry_file = folder / yaml.text("markers");
  site.registry = load_registry(site.registry_file);
  StrictYaml cameras = yaml.mapping("cameras");
  for (const StrictYaml::OtherKey& profile : cameras.take_other_keys()) {
    check_name(profile, cameras.file());
    CameraFile read = read_camera_file(folder / cameras.text(profile.name));
    site.cameras.emplace(profile.name, read.camera);
    site.map.warnings.insert(site.map.warnings.end(), read.warnings.begin(), read.warnings.end());
  }
  site.default_camera = yaml.text("default_camera");
  if (!site.cameras.contains(site.default_camera)) {
    yaml.refuse("default_camera", "'" + site.default_camera + "'", "one of the keys of cameras");
  }
  site.robot_file = folder / yaml.text("robot");
  site.robot = load_robot(site.robot_file);
  site.start = read_start(yaml.mapping("start"));
  for (StrictYaml& goal : yaml.list_of_mappings("goals")) site.goals.push_back(read_goal(goal));
  if (site.goals.empty()) yaml.refuse("goals", "an empty list", "at least one goal");
  site.places = load_places(folder);
  check_speed_limits(site);
  if (yaml.has("camera")) site.camera = yaml.text("camera");
  if (yaml.has("camera_settings")) {
    const bool is_machine_vision = site.camera.starts_with("genicam:");
    if (!is_machine_vision && !site.camera.starts_with("v4l2:"))
      yaml.refuse("camera_settings", "settings of camera '" + site.camera + "'",
                  "them only for v4l2: and genicam:");
    site.camera_settings = read_camera_settings(yaml.mapping("camera_settings"), is_machine_vision);
  }
  if (yaml.has("scanner")) {
    site.scanner = yaml.text("scanner");
    if (!site.robot.scanner)
      yaml.refuse("scanner", "'" + site.scanner + "' of a robot without one",
                  "scanner: in its robot.yaml too");
  }
  if (yaml.has("depth_camera")) {
    site.depth_camera = yaml.text("depth_camera");
    if (!site.robot.depth_camera)
      yaml.refuse("depth_camera", "'" + site.depth_camera + "' of a robot without one",
                  "depth_camera: in its robot.yaml too");
  }
  if (yaml.has("base")) site.base = read_base(yaml.mapping("base"));
  if (yaml.has("charging")) site.charging = read_charging(yaml.mapping("charging"), site);
  if (yaml.has("actions")) site.actions = read_action_hooks(yaml.list_of_mappings("actions"), folder);
  if (yaml.has("fleet")) {  // kept by who asks for it
    const FleetSettings fleet = read_fleet_settings(yaml.mapping("fleet"), folder);
    site.actions.insert(site.actions.end(), fleet.actions.begin(), fleet.actions.end());
  }
  check_actions(site);
  if (const auto why = unknown_action(site.places, site))
    throw InputError(folder / places_file_name, 0, *why, "one of the actions of site.yaml");
  yaml.finish();
  return site;
}

}  // namespace lodestar
