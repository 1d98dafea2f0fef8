#include "app/navigation/navigation_setup.hpp"

#include <algorithm>

#include "control/travel_time.hpp"

namespace lodestar {

PosePrior pose_prior(const Robot& robot) {
  PosePrior prior;
  prior.tilt = rotation_from({robot.camera_mount.roll_rad, robot.camera_mount.pitch_rad, 0.0});
  prior.tilt_sigma_rad = robot.mount_tilt_sigma_rad;
  prior.height_m = robot.base_from_camera.translation().z();
  prior.height_sigma_m = robot.mount_height_sigma_m;
  return prior;
}

KnownWorld known_world(const Site& site, const std::string& camera) {
  return {.map = site.map.map,
          .registry = site.registry,
          .camera = site.cameras.at(camera),
          .base_from_camera = site.robot.base_from_camera,
          .zones = {site.places.keep_out, site.places.speed_zones}};
}

OccupancyMap drivable_map(const Site& site) {
  return with_keep_out(site.map.map, site.places.keep_out);
}

StateOwner state_owner(const Site& site, const std::string& camera) {
  const PoseFilterOptions filter = navigation_options(site.robot).filter;
  return {.robot = site.robot.name,
          .track_width_m = filter.track_width_m,
          .wheel_step_m = filter.wheel_step_m,
          .registry = fingerprint_of(site.registry),
          .camera = fingerprint_of(site.cameras.at(camera))};
}

std::filesystem::path state_file(const Site& site) {
  return site.folder / "state.yaml";
}

std::optional<SurroundingsOptions> surroundings_options(const Robot& robot, const DriveOptions& drive) {
  if (!robot.scanner) return std::nullopt;
  SurroundingsOptions options;
  options.mount = robot.scanner->mount;
  options.shape = robot.footprint ? RobotShape(*robot.footprint) : RobotShape(robot.radius_m);
  options.wheels.track_width_m = robot.track_width_m;
  // Readings may be as old as the safety stop allows (100 ms), and a step more.
  options.wheels.ahead = std::chrono::milliseconds(120);
  options.watch.track_width_m = robot.track_width_m;
  options.field.deceleration_mps2 = robot.scanner->protective_deceleration_mps2;
  // The last of the speed dies away as a first-order lag: from 0.1 to 0.01 m/s in 2.3 of its time constants
  // of some 0.08 s, where the field counts 0.07 s for braking.
  constexpr double dying_away_s = 0.1;
  options.field.response_s = drive.response_s + dying_away_s;
  options.release.rise_mps2 = drive.max_acceleration_mps2;
  if (robot.depth_camera) {
    options.depth.emplace(DepthSourceOptions{.mount = robot.depth_camera->mount, .slab = {}});
    options.depth->slab.high_m = robot.depth_camera->robot_height_m;
  }
  return options;
}

/// A robot that may arrive far off its goal still goes as near as that, as the place is searched by the
/// millimetre.
constexpr double max_goal_slack_m = 0.015;

NavigationOptions navigation_options(const Robot& robot) {
  NavigationOptions options;
  options.fix.prior = pose_prior(robot);
  // Assumed, not measured: film is cut and glued to about 0.05 mm, and the ceiling's pattern beside a dot
  // shifts its detected centre by as much again. At 2.6 m that is 0.02 px of the paper's camera (755 px). On
  // a real ceiling, check the fixes' residual_px (run.mcap and the live viewers): half its square is about
  // the sum of the squares of this sigma and of the image noise, about 0.01 px.
  options.fix.dot_place_sigma_m = 0.00007;
  // Assumed: what a careful person reaches with a laser. The price on an exact registry is half a millimetre
  // (docs/decisions/0015-markers-off-their-places.md).
  options.fix.unstated_sigma = {.position_m = 0.003, .yaw_rad = radians(0.3)};
  // Assumed: tiles and film are level to this. A third of it would do on a level ceiling and not on one of 1
  // degree; more costs nothing (docs/decisions/0014-markers-that-are-not-level.md).
  options.fix.marker_tilt_sigma_rad = radians(1.0);
  options.filter.track_width_m = robot.track_width_m;
  options.filter.wheel_step_m = robot.encoder_step_m.value_or(options.filter.wheel_step_m);
  options.filter.wheel_noise_m_per_sqrt_m =
      robot.wheel_noise_m_per_sqrt_m.value_or(options.filter.wheel_noise_m_per_sqrt_m);
  options.filter.fix_sigma_floor_m = robot.shared_fix_sigma_m.value_or(options.filter.fix_sigma_floor_m);
  options.filter.fix_sigma_floor_rad =
      robot.shared_fix_sigma_rad.value_or(options.filter.fix_sigma_floor_rad);
  options.planner.radius_m = robot.radius_m;
  options.planner.footprint = robot.footprint;
  options.planner.preferred_clearance_m = robot.preferred_clearance_m;
  options.planner.goal_slack_m = std::min(max_goal_slack_m, 0.5 * robot.arrival_distance_m);
  options.drive.max_forward_mps = robot.max_forward_mps;
  options.drive.max_turn_radps = robot.max_turn_radps;
  options.drive.max_acceleration_mps2 = robot.max_acceleration_mps2;
  options.drive.max_turn_acceleration_radps2 = robot.max_turn_acceleration_radps2;
  options.drive.max_wheel_mps = robot.max_wheel_mps;
  options.drive.track_width_m = robot.track_width_m;
  options.drive.response_s = robot.response_s.value_or(options.drive.response_s);
  options.drive.min_forward_mps =
      robot.dead_band_mps.value_or(std::min(options.drive.min_forward_mps, robot.max_forward_mps));
  options.drive.min_turn_radps =
      robot.dead_band_radps.value_or(std::min(options.drive.min_turn_radps, robot.max_turn_radps));
  options.drive.arrival_distance_m = robot.arrival_distance_m;
  options.drive.blend_corridor_m = robot.pass_corners_within_m;
  options.drive.arrival_heading_rad = robot.arrival_heading_rad;
  options.planner.limits = motion_limits(options.drive);
  options.route.limits = options.planner.limits;
  options.surroundings = surroundings_options(robot, options.drive);
  return options;
}

}  // namespace lodestar
