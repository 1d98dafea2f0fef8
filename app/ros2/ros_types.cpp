#include "app/ros2/ros_types.hpp"

#include <functional>
#include <map>
#include <ros2_messages.h>
#include <set>
#include <sstream>

#include "app/ros2/cdr.hpp"

namespace lodestar {
namespace {

/// Fields of the .msg files, from Humble to Jazzy, in the order of the wire.
const std::map<std::string, std::string>& fields_by_type() {
  static const std::map<std::string, std::string> fields{
      {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
      {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
      {"rosgraph_msgs/Clock", "builtin_interfaces/Time clock\n"},
      {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
      {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
      {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
      {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
      {"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
      {"geometry_msgs/Transform", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
      {"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
      {"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
      {"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
      {"geometry_msgs/PoseWithCovarianceStamped",
       "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n"},
      {"geometry_msgs/TransformStamped",
       "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
      {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
      {"nav_msgs/MapMetaData",
       "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\n"
       "geometry_msgs/Pose origin\n"},
      {"nav_msgs/OccupancyGrid", "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n"},
      {"nav_msgs/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n"},
      {"nav_msgs/Odometry",
       "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
       "geometry_msgs/TwistWithCovariance twist\n"},
      {"sensor_msgs/LaserScan",
       "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n"
       "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] ranges\n"
       "float32[] intensities\n"},
      {"sensor_msgs/BatteryState",
       "std_msgs/Header header\nfloat32 voltage\nfloat32 temperature\nfloat32 current\nfloat32 charge\n"
       "float32 capacity\nfloat32 design_capacity\nfloat32 percentage\nuint8 power_supply_status\n"
       "uint8 power_supply_health\nuint8 power_supply_technology\nbool present\nfloat32[] cell_voltage\n"
       "float32[] cell_temperature\nstring location\nstring serial_number\n"},
      {"diagnostic_msgs/KeyValue", "string key\nstring value\n"},
      {"diagnostic_msgs/DiagnosticStatus",
       "byte level\nstring name\nstring message\nstring hardware_id\ndiagnostic_msgs/KeyValue[] values\n"},
      {"diagnostic_msgs/DiagnosticArray",
       "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n"}};
  return fields;
}

// Each message field by field, in the order of its definition.

void put(CdrBytes& bytes, const builtin_interfaces_msg_dds__Time_& time) {
  bytes.put(time.sec);
  bytes.put(time.nanosec);
}

void put(CdrBytes& bytes, const std_msgs_msg_dds__Header_& header) {
  put(bytes, header.stamp);
  bytes.put(header.frame_id);
}

void put(CdrBytes& bytes, const rosgraph_msgs_msg_dds__Clock_& message) {
  put(bytes, message.clock);
}

void put(CdrBytes& bytes, const geometry_msgs_msg_dds__Vector3_& vector) {
  for (const double value : {vector.x, vector.y, vector.z}) bytes.put(value);
}

void put(CdrBytes& bytes, const geometry_msgs_msg_dds__Point_& point) {
  for (const double value : {point.x, point.y, point.z}) bytes.put(value);
}

void put(CdrBytes& bytes, const geometry_msgs_msg_dds__Quaternion_& turn) {
  for (const double value : {turn.x, turn.y, turn.z, turn.w}) bytes.put(value);
}

void put(CdrBytes& bytes, const geometry_msgs_msg_dds__Pose_& pose) {
  put(bytes, pose.position);
  put(bytes, pose.orientation);
}

void put(CdrBytes& bytes, const geometry_msgs_msg_dds__PoseWithCovariance_& pose) {
  put(bytes, pose.pose);
  for (const double value : pose.covariance) bytes.put(value);
}

void put(CdrBytes& bytes, const geometry_msgs_msg_dds__TwistWithCovariance_& twist) {
  put(bytes, twist.twist.linear);
  put(bytes, twist.twist.angular);
  for (const double value : twist.covariance) bytes.put(value);
}

void put(CdrBytes& bytes, const geometry_msgs_msg_dds__PoseStamped_& pose) {
  put(bytes, pose.header);
  put(bytes, pose.pose);
}

void put(CdrBytes& bytes, const geometry_msgs_msg_dds__PoseWithCovarianceStamped_& pose) {
  put(bytes, pose.header);
  put(bytes, pose.pose);
}

void put(CdrBytes& bytes, const geometry_msgs_msg_dds__TransformStamped_& transform) {
  put(bytes, transform.header);
  bytes.put(transform.child_frame_id);
  put(bytes, transform.transform.translation);
  put(bytes, transform.transform.rotation);
}

void put(CdrBytes& bytes, const diagnostic_msgs_msg_dds__KeyValue_& pair) {
  bytes.put(pair.key);
  bytes.put(pair.value);
}

void put(CdrBytes& bytes, float value) {
  bytes.put(value);
}

void put(CdrBytes& bytes, const diagnostic_msgs_msg_dds__DiagnosticStatus_& status);

template <typename Sequence>
void put_all(CdrBytes& bytes, const Sequence& sequence) {
  bytes.put(sequence._length);
  for (std::uint32_t i = 0; i < sequence._length; ++i) put(bytes, sequence._buffer[i]);
}

void put(CdrBytes& bytes, const diagnostic_msgs_msg_dds__DiagnosticStatus_& status) {
  bytes.put(status.level);
  for (const char* text : {status.name, status.message, status.hardware_id}) bytes.put(text);
  put_all(bytes, status.values);
}

void put(CdrBytes& bytes, const tf2_msgs_msg_dds__TFMessage_& message) {
  put_all(bytes, message.transforms);
}

void put(CdrBytes& bytes, const nav_msgs_msg_dds__OccupancyGrid_& grid) {
  put(bytes, grid.header);
  put(bytes, grid.info.map_load_time);
  bytes.put(grid.info.resolution);
  bytes.put(grid.info.width);
  bytes.put(grid.info.height);
  put(bytes, grid.info.origin);
  bytes.put(grid.data._length);
  bytes.raw(grid.data._buffer, grid.data._length);
}

void put(CdrBytes& bytes, const nav_msgs_msg_dds__Path_& path) {
  put(bytes, path.header);
  put_all(bytes, path.poses);
}

void put(CdrBytes& bytes, const nav_msgs_msg_dds__Odometry_& odometry) {
  put(bytes, odometry.header);
  bytes.put(odometry.child_frame_id);
  put(bytes, odometry.pose);
  put(bytes, odometry.twist);
}

void put(CdrBytes& bytes, const sensor_msgs_msg_dds__LaserScan_& scan) {
  put(bytes, scan.header);
  for (const float value : {scan.angle_min, scan.angle_max, scan.angle_increment, scan.time_increment,
                            scan.scan_time, scan.range_min, scan.range_max})
    bytes.put(value);
  put_all(bytes, scan.ranges);
  put_all(bytes, scan.intensities);
}

void put(CdrBytes& bytes, const sensor_msgs_msg_dds__BatteryState_& battery) {
  put(bytes, battery.header);
  for (const float value : {battery.voltage, battery.temperature, battery.current, battery.charge,
                            battery.capacity, battery.design_capacity, battery.percentage})
    bytes.put(value);
  for (const std::uint8_t value :
       {battery.power_supply_status, battery.power_supply_health, battery.power_supply_technology})
    bytes.put(value);
  bytes.put(battery.present);
  put_all(bytes, battery.cell_voltage);
  put_all(bytes, battery.cell_temperature);
  bytes.put(battery.location);
  bytes.put(battery.serial_number);
}

void put(CdrBytes& bytes, const diagnostic_msgs_msg_dds__DiagnosticArray_& array) {
  put(bytes, array.header);
  put_all(bytes, array.status);
}

using Serializer = std::function<void(CdrBytes&, const void*)>;

template <typename Message>
std::pair<const dds_topic_descriptor_t*, Serializer> serializer(const dds_topic_descriptor_t& type) {
  return {&type,
          [](CdrBytes& bytes, const void* message) { put(bytes, *static_cast<const Message*>(message)); }};
}

const std::map<const dds_topic_descriptor_t*, Serializer>& serializers() {
  static const std::map<const dds_topic_descriptor_t*, Serializer> by_type{
      serializer<tf2_msgs_msg_dds__TFMessage_>(tf2_msgs_msg_dds__TFMessage__desc),
      serializer<nav_msgs_msg_dds__Odometry_>(nav_msgs_msg_dds__Odometry__desc),
      serializer<geometry_msgs_msg_dds__PoseWithCovarianceStamped_>(
          geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc),
      serializer<nav_msgs_msg_dds__OccupancyGrid_>(nav_msgs_msg_dds__OccupancyGrid__desc),
      serializer<nav_msgs_msg_dds__Path_>(nav_msgs_msg_dds__Path__desc),
      serializer<sensor_msgs_msg_dds__LaserScan_>(sensor_msgs_msg_dds__LaserScan__desc),
      serializer<diagnostic_msgs_msg_dds__DiagnosticArray_>(diagnostic_msgs_msg_dds__DiagnosticArray__desc),
      serializer<sensor_msgs_msg_dds__BatteryState_>(sensor_msgs_msg_dds__BatteryState__desc),
      serializer<rosgraph_msgs_msg_dds__Clock_>(rosgraph_msgs_msg_dds__Clock__desc)};
  return by_type;
}

/// "nav_msgs/msg/Path" as definitions name it: "nav_msgs/Path".
std::string short_name(const std::string& name) {
  const std::size_t middle = name.find("/msg/");
  return middle == std::string::npos ? name : name.substr(0, middle) + name.substr(middle + 4);
}

/// The types that a definition refers to, and theirs.
void collect(const std::string& name, std::set<std::string>& found) {
  std::istringstream lines(fields_by_type().at(name));
  for (std::string type, field; lines >> type >> field;) {
    type = type.substr(0, type.find('['));
    if (type.find('/') != std::string::npos && found.insert(type).second) collect(type, found);
  }
}

}  // namespace

std::string ros_name(const dds_topic_descriptor_t& type) {
  std::string name = type.m_typename;  // nav_msgs::msg::dds_::Path_
  name.pop_back();
  for (const auto& [from, to] : {std::pair{"::dds_::", "/"}, std::pair{"::", "/"}})
    for (std::size_t at = name.find(from); at != std::string::npos; at = name.find(from))
      name.replace(at, std::strlen(from), to);
  return name;
}

std::string ros_definition(const std::string& name) {
  constexpr std::size_t line_length = 80;
  std::string text = fields_by_type().at(short_name(name));
  std::set<std::string> others;
  collect(short_name(name), others);
  for (const std::string& other : others)
    text += std::string(line_length, '=') + "\nMSG: " + other + "\n" + fields_by_type().at(other);
  return text;
}

std::string as_cdr(const dds_topic_descriptor_t& type, const void* message) {
  CdrBytes bytes;
  serializers().at (&type)(bytes, message);
  return bytes.get();
}

}  // namespace lodestar
