#pragma once

#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "app/common/log.hpp"
#include "app/ros2/ros2_link.hpp"
#include "app/ros2/ros2_options.hpp"
#include "app/site/site.hpp"

namespace lodestar {

/// The robot as a ROS 2 node, on a thread of its own with lower priority than the control loop: sends what
/// the link has, and gives it what the topics initialpose, goal_pose and odom bring, where `options` allow
/// it.
class Ros2Transport {
 public:
  /// Throws InputError where the network cannot be used. `tell`: events, in words.
  Ros2Transport(const Site& site, const Ros2Options& options, Ros2Link& link,
                std::function<void(Severity, const std::string&)> tell);
  ~Ros2Transport();
  Ros2Transport(const Ros2Transport&) = delete;
  Ros2Transport& operator=(const Ros2Transport&) = delete;

 private:
  class Node;

  std::unique_ptr<Node> node_;
  std::jthread thread_;  ///< ends first
};

}  // namespace lodestar
