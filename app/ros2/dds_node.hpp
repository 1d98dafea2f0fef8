#pragma once

#include <dds/dds.h>
#include <memory>
#include <string>
#include <vector>

#include "app/ros2/ros2_options.hpp"
#include "app/ros2/ros_output.hpp"

namespace lodestar {

/// A DDS participant that appears as a ROS 2 node: endpoints by topic, the type hash of each, and the message
/// that tells which of them make up the node. All of one thread. Throws InputError where the network
/// interface or the domain cannot be used.
class DdsNode final : public RosOutput {
 public:
  DdsNode(const std::string& name, const Ros2Options& options);
  ~DdsNode() override;
  DdsNode(const DdsNode&) = delete;
  DdsNode& operator=(const DdsNode&) = delete;

  [[nodiscard]] int open(const RosTopic& topic) override;
  /// A message is lost to a reliable reader that does not keep up: nobody waits for it.
  void write(int topic, const void* message, Stamp stamp) override;
  [[nodiscard]] dds_entity_t make_reader(const RosTopic& topic);
  /// Tells other nodes what this one consists of; again after endpoints were made.
  void announce();

 private:
  dds_entity_t make_topic(const char* name, const dds_topic_descriptor_t& type) const;

  std::string name_;
  RosDistro distro_;
  dds_entity_t domain_ = 0;
  dds_entity_t participant_ = 0;
  dds_entity_t discovery_ = 0;
  std::vector<dds_entity_t> writers_;
  std::vector<dds_entity_t> readers_;
};

/// Takes the messages that wait at a reader, oldest first: Take is called with each, by reference.
template <typename Message, typename Take>
void take_all(dds_entity_t reader, Take take) {
  void* sample = nullptr;
  dds_sample_info_t info{};
  while (true) {
    sample = nullptr;  // the library lends one
    const dds_return_t count = dds_take(reader, &sample, &info, 1, 1);
    if (count <= 0) return;
    if (info.valid_data) take(*static_cast<const Message*>(sample));
    (void)dds_return_loan(reader, &sample, count);
  }
}

}  // namespace lodestar
