#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/site/charging_settings.hpp"
#include "app/site/fleet_settings.hpp"
#include "app/site/goal.hpp"
#include "drivers/base/base_state.hpp"
#include "maps/camera_model.hpp"
#include "maps/depth_image.hpp"
#include "maps/footprint.hpp"
#include "maps/map_file.hpp"
#include "maps/marker_registry.hpp"
#include "maps/motion.hpp"
#include "maps/places.hpp"
#include "maps/scan.hpp"

namespace lodestar {

/// What is particular about the firmware of the robot's base.
struct BaseSettings {
  /// Reported faults that do not stop it: names of the model, or numbers of bits, such as "0x0800".
  std::vector<std::string> ignored_faults;
  std::vector<ControlMode>
      modes;  ///< of AgileX: meaning of the control mode's values 0, 1 ...; empty: the model's
  std::filesystem::path file;  ///< and line, for messages
  int line = 0;
};

/// A laser scanner on the robot, and how hard the robot may brake before what it sees.
struct RobotScanner {
  ScannerMount mount;
  /// Measured on this base and floor: what it reaches whenever the protective field stops it.
  double protective_deceleration_mps2 = 1.5;
};

/// A depth camera on the robot, for what hangs or stands above the plane of its scanner.
struct RobotDepthCamera {
  DepthMount mount;
  double robot_height_m = 0.0;  ///< what hangs higher does not touch the robot
};

/// The robot, as robot.yaml describes it.
struct Robot {
  std::string name;
  double radius_m = 0.0;
  std::optional<Footprint> footprint;  ///< the outline, when paths are planned for it and not for a disc
  double track_width_m = 0.0;
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();
  RollPitchYaw camera_mount;          ///< the rotation of base_from_camera, Rz(yaw) Ry(pitch) Rx(roll)
  double mount_tilt_sigma_rad = 0.0;  ///< standard deviation of the camera's roll and pitch while driving
  double mount_height_sigma_m = 0.0;
  // Error that neighbouring fixes share: survey, mount and floor. Nothing: the filter's default.
  std::optional<double> shared_fix_sigma_m;
  std::optional<double> shared_fix_sigma_rad;
  double preferred_clearance_m = 0.0;
  double pass_corners_within_m = 0.0;  ///< gentle corners are blended within this distance of the path
  double max_forward_mps = 0.0;
  double max_turn_radps = 0.0;
  double max_acceleration_mps2 = 0.0;
  double max_turn_acceleration_radps2 = 0.0;
  double max_wheel_mps = 0.0;
  double arrival_distance_m = 0.0;
  double arrival_heading_rad = 0.0;
  // What differs from base to base; nothing: the defaults of DriveOptions and PoseFilterOptions.
  std::optional<double> response_s;
  std::optional<double> dead_band_mps;
  std::optional<double> dead_band_radps;
  std::optional<double> encoder_step_m;
  std::optional<double> wheel_noise_m_per_sqrt_m;
  BaseSettings base;
  std::optional<RobotScanner> scanner;
  std::optional<RobotDepthCamera> depth_camera;  ///< of a robot with a scanner
};

/// How the real base is connected.
struct BaseConnection {
  std::string interface;            ///< of CAN
  std::string protocol = "agilex";  ///< or "odrive"
  std::string model = "tracer";     ///< of AgileX: or "scout", "hunter"; their fault bits differ
  // Of ODrive: which node drives which wheel.
  double wheel_diameter_m = 0.17;
  int left_node = 0;
  int right_node = 1;
  bool right_is_mirrored = true;  ///< turns backwards when the robot drives forward
};

/// Of a V4L2 camera; empty: as the camera is set, and as its driver flags its stamps.
struct CameraSettings {
  std::optional<double> exposure_s;
  std::optional<double> gain;  ///< in the driver's unit; a whole number for V4L2
  std::optional<double> rate_hz;
  double latency_s = 0.0;                ///< from the end of exposure to the stamp of arrival
  std::optional<bool> stamped_at_start;  ///< of exposure; false: at arrival
};

/// A site folder: the map, the markers above it, the cameras, the robot and the usual drive.
struct Site {
  std::string name;
  std::filesystem::path folder;
  LoadedMap map;
  std::filesystem::path map_file;
  std::optional<std::filesystem::path> octomap_file;  ///< of the same site, where there is one
  MarkerRegistry registry;
  std::filesystem::path registry_file;
  std::map<std::string, CameraModel> cameras;
  std::string default_camera;
  std::filesystem::path robot_file;
  Robot robot;
  Pose2 start;
  std::vector<Goal> goals;
  Places places;
  std::string camera;  ///< the camera device, or "simulated"; empty when the site names none
  CameraSettings camera_settings;
  std::string scanner;                 ///< where the robot's scanner is; empty when the site names none
  std::string depth_camera;            ///< likewise
  std::optional<BaseConnection> base;  ///< nothing when the site is for simulation only
  std::optional<ChargingSettings> charging;
  std::vector<ActionHook> actions;  ///< that missions may ask for: those of a fleet, too
};

/// Reads `folder`/site.yaml, all files that it names, and places.yaml beside it if there is one. Throws
/// InputError with file and line.
Site load_site(const std::filesystem::path& folder);

/// Of a mission over these places that the site has no program for, in words.
std::optional<std::string> unknown_action(const Places& places, const Site& site);

Robot load_robot(const std::filesystem::path& file);

}  // namespace lodestar
