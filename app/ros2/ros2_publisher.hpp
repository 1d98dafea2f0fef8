#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/ros2/ros2_options.hpp"
#include "app/ros2/ros2_report.hpp"
#include "app/ros2/ros_output.hpp"
#include "app/site/fleet_settings.hpp"
#include "app/site/site.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

/// Sends the robot's state as ROS 2's navigation stack names and shapes it. Frames by REP 105: map -> odom ->
/// base_link; units and axes by REP 103; diagnostics once a second and on change, by REP 107.
class Ros2Publisher {
 public:
  Ros2Publisher(RosOutput& output, const Site& site, const Ros2Options& options);

  /// The map and the mounts, once: who joins late gets them. `clock_offset` is what ROS's clock is ahead of
  /// the robot's.
  void publish_scene(Stamp now, Duration clock_offset);
  void publish(const Ros2Report& report, Duration clock_offset);

 private:
  /// Numbers of the topics at the output.
  struct Topics {
    Topics(RosOutput& output, const Ros2Options& options);
    int tf, tf_static, amcl_pose, map, plan, scan, diagnostics, battery;
    std::optional<int> odom, clock;
  };

  void write(int topic, const void* message, Stamp stamp) {
    output_.write(topic, message, stamp + clock_offset_);
  }
  void send_clock(Stamp now);
  void send_transforms(const Ros2Report& report);
  void send_odometry(const Ros2Report& report);
  void send_pose(const PoseEstimate& estimate);
  void send_plan(const Path& path, Stamp now);
  void send_scan(const Scan& scan);
  void send_diagnostics(const Ros2Report& report);
  void send_battery(double battery_v, Stamp stamp);

  RosOutput& output_;
  Ros2Options options_;
  OccupancyMap map_;
  Eigen::Isometry3d base_from_camera_;
  std::optional<ScannerMount> scanner_;
  std::string robot_;
  std::optional<BatteryCurve> battery_curve_;
  Topics topics_;
  Duration clock_offset_{};
  std::optional<Stamp> last_pose_, last_battery_, last_diagnostics_;
  std::string said_;  ///< by the diagnostics
  std::shared_ptr<const Path> path_;
};

}  // namespace lodestar
