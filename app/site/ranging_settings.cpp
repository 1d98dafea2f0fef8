#include "app/site/ranging_settings.hpp"

namespace lodestar {

RobotScanner read_scanner(StrictYaml yaml) {
  RobotScanner scanner;
  const double x_m = yaml.number("x_m", -10.0, 10.0);
  const double y_m = yaml.number("y_m", -10.0, 10.0);
  scanner.mount.height_m = yaml.number("z_m", 0.0, 3.0);
  scanner.mount.base_from_scanner = {{x_m, y_m}, wrap_angle(radians(yaml.number("yaw_deg", -360.0, 360.0)))};
  scanner.protective_deceleration_mps2 = yaml.number("protective_deceleration_mps2", 0.2, 10.0);
  yaml.finish();
  return scanner;
}

RobotDepthCamera read_depth_camera(StrictYaml yaml) {
  RobotDepthCamera depth;
  CameraModel& camera = depth.mount.camera;
  const Vec3 place_m(yaml.number("x_m", -10.0, 10.0), yaml.number("y_m", -10.0, 10.0),
                     yaml.number("z_m", 0.0, 3.0));
  const double yaw_rad = radians(yaml.number("yaw_deg", -360.0, 360.0));
  const double down_rad = radians(yaml.number("pitch_down_deg", -90.0, 90.0));
  camera.width_px = yaml.integer("width_px", 16, 4096);
  camera.height_px = yaml.integer("height_px", 16, 4096);
  camera.fx_px = yaml.number("fx_px", 8.0, 20'000.0);
  camera.fy_px = yaml.number("fy_px", 8.0, 20'000.0);
  camera.cx_px = yaml.number("cx_px", 0.0, 4096.0);
  camera.cy_px = yaml.number("cy_px", 0.0, 4096.0);
  depth.mount.range_m = yaml.number("range_m", 0.5, 10.0);
  depth.robot_height_m = yaml.number("robot_height_m", 0.1, 3.0);
  yaml.finish();
  Eigen::Matrix3d ahead;  // x right, y down, z ahead of a camera that looks along the base's x axis
  ahead << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  depth.mount.base_from_camera.translation() = place_m;
  depth.mount.base_from_camera.linear() = Eigen::AngleAxisd(yaw_rad, Vec3::UnitZ()) *
                                          Eigen::AngleAxisd(down_rad, Vec3::UnitY()).toRotationMatrix() *
                                          ahead;
  return depth;
}

}  // namespace lodestar
