#include "app/commands/ros2_service.hpp"

#include "app/common/log.hpp"
#include "drivers/system/clock.hpp"

namespace lodestar {

void add_ros2_options(CLI::App& command, Ros2Arguments& arguments) {
  constexpr int last_domain = 232;  // beyond, the ports of DDS end
  CLI::Option* ros2 = command.add_flag("--ros2", arguments.is_wanted,
                                       "Appear as a ROS 2 node: tf, odom, amcl_pose, map, plan, scan, "
                                       "diagnostics, battery_state, and clock in simulation");
  command
      .add_flag("--ros2-commands", arguments.takes_commands,
                "Take topics initialpose and goal_pose too, from anybody in the network")
      ->needs(ros2);
  command.add_option("--ros-domain", arguments.domain, "ROS_DOMAIN_ID")
      ->needs(ros2)
      ->check(CLI::Range(0, last_domain))
      ->capture_default_str();
  command.add_option("--ros-distro", arguments.distro, "humble or jazzy: what its tools expect of a node")
      ->needs(ros2)
      ->check(CLI::IsMember({"humble", "jazzy"}))
      ->capture_default_str();
  command.add_option("--ros2-bag", arguments.bag,
                     "Record all that in an MCAP file, which `ros2 bag` plays; with or without --ros2");
  command
      .add_option("--ros-interface", arguments.interface, "Network interface; default: the system's choice")
      ->needs(ros2);
}

Ros2Options ros2_options(const Ros2Arguments& arguments, bool is_simulated) {
  return {.domain = arguments.domain,
          .interface = arguments.interface,
          .distro = arguments.distro == "humble" ? RosDistro::humble : RosDistro::jazzy,
          .takes_commands = arguments.takes_commands,
          .is_simulated = is_simulated};
}

Ros2Service::Ros2Service(const Site& site, const Ros2Options& options)
    : session_(link_, options, site.robot.track_width_m, log_info),
      transport_(site, options, link_,
                 [](Severity severity, const std::string& words) { program_log().say(severity, words); }) {}

Ros2Companion::Ros2Companion(const Site& site, const Ros2Arguments& arguments, bool is_simulated) {
  if (arguments.is_wanted) service_.emplace(site, ros2_options(arguments, is_simulated));
  if (arguments.bag.empty()) return;
  bag_.emplace(arguments.bag, site,
               Ros2BagOptions{.is_simulated = is_simulated,
                              .clock_offset = is_simulated ? Duration{} : system_clock_offset(),
                              .tell = [](const std::string& words) { log_warning(words); }});
}

void Ros2Companion::attend(const SensorInput& input, const MissionStep& step, Mission& mission) {
  if (service_) service_->session().attend(input, step, mission);
  if (bag_) bag_->attend(input, step, mission);
}

bool Ros2Companion::finish() {
  const std::string loss = bag_ ? bag_->finish() : "";
  if (!loss.empty()) log_warning("ros2: " + loss);
  return loss.empty();
}

}  // namespace lodestar
