#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/common/background_writer.hpp"
#include "app/ros2/ros2_publisher.hpp"
#include "app/ros2/ros2_session.hpp"
#include "app/site/site.hpp"
#include "app/viewers/mcap_file.hpp"

namespace lodestar {

struct Ros2BagOptions {
  bool is_simulated =
      false;                ///< stamps are simulated time, which /clock tells, and a drive waits for the disk
  Duration clock_offset{};  ///< what ROS's clock is ahead of the robot's
  std::function<void(const std::string&)> tell;  ///< once, when the file is no longer whole
};

/// Records what the robot says as a ROS 2 node in an MCAP file, as CDR with definitions (ros2msg): `ros2 bag`
/// plays it, and Foxglove shows it. On a thread of its own, so that a slow disk never delays wheel commands.
class Ros2Bag {
 public:
  /// Throws InputError when the file cannot be made.
  Ros2Bag(const std::filesystem::path& file, const Site& site, const Ros2BagOptions& options);

  /// Call after each step.
  void attend(const SensorInput& input, const MissionStep& step, Mission& mission);

  /// Waits until everything is written. What is missing and why; empty when nothing is.
  std::string finish();

 private:
  /// The topics are known once the publisher is made; the file begins with them.
  class File final : public RosOutput {
   public:
    explicit File(std::filesystem::path name) : name_(std::move(name)) {}
    [[nodiscard]] int open(const RosTopic& topic) override;
    void write(int topic, const void* message, Stamp stamp) override;
    void begin();
    void finish();

   private:
    std::filesystem::path name_;
    std::vector<Channel> channels_;
    std::vector<const dds_topic_descriptor_t*> types_;
    std::unique_ptr<McapFile> mcap_;
  };

  Ros2Link link_;
  Ros2Session session_;
  File file_;  ///< the writer's alone while it works
  Ros2Publisher publisher_;
  Duration clock_offset_;
  bool has_begun_ = false;
  BackgroundWriter<Ros2Report> writer_;
};

}  // namespace lodestar
