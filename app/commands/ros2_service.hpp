#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "app/ros2/ros2_session.hpp"
#include "app/ros2/ros2_transport.hpp"
#include "app/site/site.hpp"
#include "app/viewers/ros2_bag.hpp"

namespace lodestar {

/// `--ros2` and the options beside it.
struct Ros2Arguments {
  bool is_wanted = false;
  bool takes_commands = false;
  int domain = 0;
  std::string distro = "jazzy";
  std::string interface;
  std::string bag;  ///< file; empty: none
};

/// Fills the arguments, which must outlive the application.
void add_ros2_options(CLI::App& command, Ros2Arguments& arguments);

Ros2Options ros2_options(const Ros2Arguments& arguments, bool is_simulated);

/// The robot as a ROS 2 node.
class Ros2Service {
 public:
  /// Throws InputError where the network cannot be used.
  Ros2Service(const Site& site, const Ros2Options& options);

  [[nodiscard]] Ros2Session& session() { return session_; }

 private:
  Ros2Link link_;
  Ros2Session session_;
  Ros2Transport transport_;  ///< ends first: it uses the link
};

/// A drive as ROS 2 is to see it: the node, the bag, both, or neither.
class Ros2Companion {
 public:
  Ros2Companion(const Site& site, const Ros2Arguments& arguments, bool is_simulated);

  [[nodiscard]] bool is_wanted() const { return service_ || bag_; }
  /// Call after each step.
  void attend(const SensorInput& input, const MissionStep& step, Mission& mission);
  /// After the last one. False, and told, when the bag is not whole.
  [[nodiscard]] bool finish();

 private:
  std::optional<Ros2Service> service_;
  std::optional<Ros2Bag> bag_;
};

}  // namespace lodestar
