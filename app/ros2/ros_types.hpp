#pragma once

#include <dds/dds.h>
#include <string>

namespace lodestar {

/// The name of a type as ROS has it, such as nav_msgs/msg/Path.
std::string ros_name(const dds_topic_descriptor_t& type);

/// Its definition with those that it refers to, as files of messages have it (schema encoding ros2msg).
/// Throws std::out_of_range for a type that is not among ours.
std::string ros_definition(const std::string& name);

/// A message of this type in plain CDR, with the header of four bytes. Throws std::out_of_range for a type
/// that is not among ours.
std::string as_cdr(const dds_topic_descriptor_t& type, const void* message);

}  // namespace lodestar
