#pragma once

#include <dds/dds.h>

#include "maps/stamp.hpp"

namespace lodestar {

/// How an endpoint offers or wants its topic: the QoS that ROS 2's own nodes use for it.
struct TopicQos {
  bool keeps_for_late = false;  ///< transient local: who joins late gets the newest
  int depth = 10;
};

struct RosTopic {
  const char* name;  ///< as ROS shows it, without the leading slash
  const dds_topic_descriptor_t* type;
  const char* type_hash;  ///< RIHS01_..., REP 2016; names the type where definitions are compared
  TopicQos qos;
};

/// Where messages go: to other nodes, or into a file.
class RosOutput {
 public:
  RosOutput() = default;
  RosOutput(const RosOutput&) = delete;
  RosOutput& operator=(const RosOutput&) = delete;
  virtual ~RosOutput() = default;

  /// The number by which messages of this topic are written.
  [[nodiscard]] virtual int open(const RosTopic& topic) = 0;
  /// `message` has the topic's type. `stamp`: ROS's time.
  virtual void write(int topic, const void* message, Stamp stamp) = 0;
};

}  // namespace lodestar
