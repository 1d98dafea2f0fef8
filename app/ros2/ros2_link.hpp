#pragma once

#include <mutex>
#include <vector>

#include "app/ros2/ros2_report.hpp"

namespace lodestar {

/// Connects the control loop, which must never wait, with the thread that speaks to ROS 2, which may: as
/// LiveLink does for the console. Both ways are bounded: of reports that nobody takes the newest 64 wait, a
/// second and more, and of commands the first 16.
class Ros2Link {
 public:
  // -- the control loop's side: no call waits

  void publish(Ros2Report report);
  /// Since the last call, oldest first.
  [[nodiscard]] std::vector<Ros2Command> take_commands();
  /// The robot's odometry by topic odom, since the last call, oldest first.
  [[nodiscard]] std::vector<OdometryReading> take_odometry();

  // -- the other side

  /// Since the last call, oldest first.
  [[nodiscard]] std::vector<Ros2Report> take_reports();
  /// False when the queue is full.
  [[nodiscard]] bool give(Ros2Command command);
  void give(const OdometryReading& reading);

 private:
  std::mutex mutex_;  ///< of all below
  std::vector<Ros2Report> reports_;
  std::vector<Ros2Command> commands_;
  std::vector<OdometryReading> odometry_;
};

}  // namespace lodestar
