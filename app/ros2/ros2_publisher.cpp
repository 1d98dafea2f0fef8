#include "app/ros2/ros2_publisher.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <ros2_messages.h>

#include "app/ros2/ros2_shapes.hpp"
#include "app/ros2/ros2_topics.hpp"

namespace lodestar {
namespace {

// Frames by REP 105 and REP 103. The library takes pointers to what may be changed, and changes nothing.
std::string map_frame = "map";
std::string odom_frame = "odom";
std::string base_frame = "base_link";
std::string camera_frame = "camera_optical";
std::string scanner_frame = "scanner";
std::string no_text;

constexpr Duration pose_period = std::chrono::milliseconds(100);
constexpr Duration slow_period = std::chrono::seconds(1);  // REP 107

builtin_interfaces_msg_dds__Time_ ros_time(Stamp stamp, Duration clock_offset) {
  const auto since = (stamp + clock_offset).time_since_epoch();
  const auto whole = std::chrono::floor<std::chrono::seconds>(since);
  return {.sec = static_cast<std::int32_t>(whole.count()),
          .nanosec = static_cast<std::uint32_t>((since - whole).count())};
}

geometry_msgs_msg_dds__Quaternion_ quaternion_of(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond turn(pose.rotation());
  return {.x = turn.x(), .y = turn.y(), .z = turn.z(), .w = turn.w()};
}

geometry_msgs_msg_dds__Pose_ pose_of(const Pose2& pose) {
  return {.position = {.x = pose.position_m.x(), .y = pose.position_m.y(), .z = 0.0},
          .orientation = quaternion_of(lifted(pose))};
}

geometry_msgs_msg_dds__Transform_ transform_of(const Eigen::Isometry3d& pose) {
  const Vec3 at = pose.translation();
  return {.translation = {.x = at.x(), .y = at.y(), .z = at.z()}, .rotation = quaternion_of(pose)};
}

/// Of (x, y, yaw), in the order of ROS: x, y, z, roll, pitch, yaw, row by row.
void put_covariance(const Eigen::Matrix3d& planar, geometry_msgs_msg_dds__covariance_36 covariance) {
  constexpr std::array<int, 3> places{0, 1, 5};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      covariance[6 * places[static_cast<std::size_t>(row)] + places[static_cast<std::size_t>(column)]] =
          planar(row, column);
}

/// Lets a sequence of the library point at these items, which must outlive its use.
template <typename Sequence, typename Item>
void lend(Sequence& sequence, std::vector<Item>& items) {
  sequence._buffer = items.data();
  sequence._length = sequence._maximum = static_cast<std::uint32_t>(items.size());
  sequence._release = false;
}

}  // namespace

Ros2Publisher::Topics::Topics(RosOutput& output, const Ros2Options& options)
    : tf(output.open(ros_topics::tf)),
      tf_static(output.open(ros_topics::tf_static)),
      amcl_pose(output.open(ros_topics::amcl_pose)),
      map(output.open(ros_topics::map)),
      plan(output.open(ros_topics::plan)),
      scan(output.open(ros_topics::scan)),
      diagnostics(output.open(ros_topics::diagnostics)),
      battery(output.open(ros_topics::battery_state)) {
  if (options.publishes_odometry) odom = output.open(ros_topics::odom);
  if (options.is_simulated) clock = output.open(ros_topics::clock);
}

Ros2Publisher::Ros2Publisher(RosOutput& output, const Site& site, const Ros2Options& options)
    : output_(output),
      options_(options),
      map_(axis_aligned(site.map.map)),
      base_from_camera_(site.robot.base_from_camera),
      robot_(site.robot.name),
      battery_curve_(load_battery_curve(site.robot_file)),
      topics_(output, options) {
  if (site.robot.scanner) scanner_ = site.robot.scanner->mount;
}

void Ros2Publisher::publish_scene(Stamp now, Duration clock_offset) {
  clock_offset_ = clock_offset;
  const auto start = ros_time(now, clock_offset);
  std::vector<geometry_msgs_msg_dds__TransformStamped_> mounts;
  const auto add = [&](std::string& frame, const Eigen::Isometry3d& pose) {
    mounts.push_back({.header = {.stamp = start, .frame_id = base_frame.data()},
                      .child_frame_id = frame.data(),
                      .transform = transform_of(pose)});
  };
  add(camera_frame, base_from_camera_);
  if (scanner_) add(scanner_frame, lifted(scanner_->base_from_scanner, scanner_->height_m));
  tf2_msgs_msg_dds__TFMessage_ transforms{};
  lend(transforms.transforms, mounts);
  write(topics_.tf_static, &transforms, now);

  nav_msgs_msg_dds__OccupancyGrid_ grid{.header = {.stamp = start, .frame_id = map_frame.data()},
                                        .info = {.map_load_time = start,
                                                 .resolution = static_cast<float>(map_.resolution_m),
                                                 .width = static_cast<std::uint32_t>(map_.columns),
                                                 .height = static_cast<std::uint32_t>(map_.rows),
                                                 .origin = pose_of(map_.map_from_grid)},
                                        .data = {}};
  std::vector<std::uint8_t> cells(map_.cells.begin(), map_.cells.end());  // -1 is 255 there
  lend(grid.data, cells);
  write(topics_.map, &grid, now);
}

void Ros2Publisher::publish(const Ros2Report& report, Duration clock_offset) {
  const auto is_due = [&](std::optional<Stamp>& last, Duration period) {
    if (last && report.now - *last < period) return false;
    last = report.now;
    return true;
  };
  clock_offset_ = clock_offset;
  if (topics_.clock) send_clock(report.now);
  send_transforms(report);
  if (topics_.odom && report.odom_from_base) send_odometry(report);
  if (report.estimate && is_due(last_pose_, pose_period)) send_pose(*report.estimate);
  for (const Scan& scan : report.scans) send_scan(scan);
  if (report.path != path_) send_plan(report.path ? *report.path : Path{}, report.now);
  path_ = report.path;
  if (report.battery_v && is_due(last_battery_, slow_period)) send_battery(*report.battery_v, report.now);
  std::string words;
  for (const DiagnosticLine& line : diagnostics_of(report))
    words += std::to_string(static_cast<int>(line.level));
  if (words != said_ || is_due(last_diagnostics_, slow_period)) {
    last_diagnostics_ = report.now;
    said_ = words;
    send_diagnostics(report);
  }
}

void Ros2Publisher::send_clock(Stamp now) {
  const rosgraph_msgs_msg_dds__Clock_ message{.clock = ros_time(now, clock_offset_)};
  write(*topics_.clock, &message, now);
}

void Ros2Publisher::send_transforms(const Ros2Report& report) {
  if (!report.odom_from_base) return;
  const auto stamp = ros_time(report.odometry_stamp, clock_offset_);
  std::vector<geometry_msgs_msg_dds__TransformStamped_> chain;
  if (report.estimate) {
    const Pose2 map_from_odom = report.estimate->map_from_base * inverse(*report.odom_from_base);
    chain.push_back({.header = {.stamp = stamp, .frame_id = map_frame.data()},
                     .child_frame_id = odom_frame.data(),
                     .transform = transform_of(lifted(map_from_odom))});
  }
  if (options_.publishes_odometry)
    chain.push_back({.header = {.stamp = stamp, .frame_id = odom_frame.data()},
                     .child_frame_id = base_frame.data(),
                     .transform = transform_of(lifted(*report.odom_from_base))});
  if (chain.empty()) return;
  tf2_msgs_msg_dds__TFMessage_ message{};
  lend(message.transforms, chain);
  write(topics_.tf, &message, report.odometry_stamp);
}

/// Covariances of zero say that none is known; what the pose is worth, amcl_pose says.
void Ros2Publisher::send_odometry(const Ros2Report& report) {
  nav_msgs_msg_dds__Odometry_ message{};
  message.header = {.stamp = ros_time(report.odometry_stamp, clock_offset_), .frame_id = odom_frame.data()};
  message.child_frame_id = base_frame.data();
  message.pose.pose = pose_of(*report.odom_from_base);
  message.twist.twist.linear.x = report.velocity.forward_mps;
  message.twist.twist.angular.z = report.velocity.turn_radps;
  write(*topics_.odom, &message, report.odometry_stamp);
}

void Ros2Publisher::send_pose(const PoseEstimate& estimate) {
  geometry_msgs_msg_dds__PoseWithCovarianceStamped_ message{};
  message.header = {.stamp = ros_time(estimate.stamp, clock_offset_), .frame_id = map_frame.data()};
  message.pose.pose = pose_of(estimate.map_from_base);
  put_covariance(estimate.covariance, message.pose.covariance);
  write(topics_.amcl_pose, &message, estimate.stamp);
}

/// Each waypoint looks along the leg that begins there. Without waypoints: there is no plan any more.
void Ros2Publisher::send_plan(const Path& path, Stamp now) {
  const auto stamp = ros_time(now, clock_offset_);
  std::vector<geometry_msgs_msg_dds__PoseStamped_> poses;
  const std::vector<Vec2>& points = path.waypoints_m;
  double yaw_rad = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i + 1 < points.size()) yaw_rad = heading_between(points[i], points[i + 1]);
    poses.push_back(
        {.header = {.stamp = stamp, .frame_id = map_frame.data()}, .pose = pose_of({points[i], yaw_rad})});
  }
  nav_msgs_msg_dds__Path_ message{};
  message.header = {.stamp = stamp, .frame_id = map_frame.data()};
  lend(message.poses, poses);
  write(topics_.plan, &message, now);
}

void Ros2Publisher::send_scan(const Scan& scan) {
  EvenScan beams = even(scan);
  sensor_msgs_msg_dds__LaserScan_ message{
      .header = {.stamp = ros_time(beams.stamp, clock_offset_), .frame_id = scanner_frame.data()},
      .angle_min = static_cast<float>(beams.first_rad),
      .angle_max = static_cast<float>(
          beams.first_rad +
          beams.step_rad * static_cast<double>(std::max<std::size_t>(beams.ranges_m.size(), 1) - 1)),
      .angle_increment = static_cast<float>(beams.step_rad),
      .time_increment = static_cast<float>(beams.step_s),
      .scan_time = static_cast<float>(beams.turn_s),
      .range_min = static_cast<float>(beams.min_range_m),
      .range_max = static_cast<float>(beams.max_range_m),
      .ranges = {},
      .intensities = {}};
  lend(message.ranges, beams.ranges_m);
  lend(message.intensities, beams.intensities);
  write(topics_.scan, &message, beams.stamp);
}

void Ros2Publisher::send_diagnostics(const Ros2Report& report) {
  std::vector<DiagnosticLine> lines = diagnostics_of(report);
  std::vector<std::vector<diagnostic_msgs_msg_dds__KeyValue_>> values(lines.size());
  std::vector<diagnostic_msgs_msg_dds__DiagnosticStatus_> all;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    DiagnosticLine& line = lines[i];
    for (auto& [key, value] : line.values) values[i].push_back({.key = key.data(), .value = value.data()});
    diagnostic_msgs_msg_dds__DiagnosticStatus_ status{.level = static_cast<std::uint8_t>(line.level),
                                                      .name = line.name.data(),
                                                      .message = line.message.data(),
                                                      .hardware_id = robot_.data(),
                                                      .values = {}};
    lend(status.values, values[i]);
    all.push_back(status);
  }
  diagnostic_msgs_msg_dds__DiagnosticArray_ message{};
  message.header = {.stamp = ros_time(report.now, clock_offset_), .frame_id = no_text.data()};
  lend(message.status, all);
  write(topics_.diagnostics, &message, report.now);
}

void Ros2Publisher::send_battery(double battery_v, Stamp stamp) {
  constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
  const float share =
      battery_curve_ ? static_cast<float>(battery_curve_->percent_at(battery_v) / 100.0) : unknown;
  const sensor_msgs_msg_dds__BatteryState_ message{
      .header = {.stamp = ros_time(stamp, clock_offset_), .frame_id = no_text.data()},
      .voltage = static_cast<float>(battery_v),
      .temperature = unknown,
      .current = unknown,
      .charge = unknown,
      .capacity = unknown,
      .design_capacity = unknown,
      .percentage = share,
      .power_supply_status = 0,
      .power_supply_health = 0,
      .power_supply_technology = 0,
      .present = true,
      .cell_voltage = {},
      .cell_temperature = {},
      .location = no_text.data(),
      .serial_number = no_text.data()};
  write(topics_.battery, &message, stamp);
}

}  // namespace lodestar
