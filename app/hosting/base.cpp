#include <charconv>
#include <fmt/core.h>
#include <memory>
#include <string>
#include <vector>

#include "app/common/interruption.hpp"
#include "app/common/log.hpp"
#include "app/hosting/hosting.hpp"
#include "app/site/site.hpp"
#include "app/site/site_folder.hpp"
#include "drivers/simulation/hosted_base.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

struct BaseArguments {
  std::string interface;
  std::string world;
  std::string protocol = "agilex";
  std::string site;
  bool dbc = false;
  std::uint64_t seed = 1;
  std::vector<std::string> faults;
  double watchdog_s = 0.0;
};

/// Seconds, not negative; nothing when the text is no such number.
std::optional<Duration> duration_in(const std::string& text) {
  double value_s = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value_s);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  if (!is_number || !(value_s >= 0.0 && value_s < 1e6)) return std::nullopt;
  return from_seconds(value_s);
}

/// NAME@SECONDS[+SECONDS]
FaultSwitch parse_fault(const std::string& text) {
  const std::size_t at = text.find('@');
  const std::size_t plus = text.find('+', at == std::string::npos ? text.size() : at);
  if (at != std::string::npos) {
    const auto fault = fault_named(text.substr(0, at));
    const auto begin = duration_in(text.substr(at + 1, plus == std::string::npos ? plus : plus - at - 1));
    const auto lasting =
        plus == std::string::npos ? std::optional<Duration>() : duration_in(text.substr(plus + 1));
    if (fault && begin && (lasting || plus == std::string::npos)) return {*fault, *begin, lasting};
  }
  throw InputError(fmt::format(
      "--fault: found '{}', wanted NAME@SECONDS or NAME@SECONDS+SECONDS with one of the names silent, estop, "
      "remote, fault-bits, stuck-counter, ignores, runaway, stuck-encoder, slip, kidnap",
      text));
}

HostedProtocol protocol_of(const BaseArguments& arguments) {
  return arguments.protocol == "odrive" ? HostedProtocol::odrive : HostedProtocol::agilex;
}

HostedBaseOptions options_from(const BaseArguments& arguments) {
  HostedBaseOptions options;
  options.interface = arguments.interface;
  options.protocol = protocol_of(arguments);
  options.world = arguments.world;
  options.seed = arguments.seed;
  if (arguments.watchdog_s > 0.0) {
    if (options.protocol != HostedProtocol::odrive)
      throw InputError("--watchdog: found protocol agilex, wanted odrive: only its axes have one");
    options.watchdog = from_seconds(arguments.watchdog_s);
  }
  for (const std::string& text : arguments.faults) options.faults.push_back(parse_fault(text));
  if (arguments.site.empty()) return options;
  const Site site = open_site(arguments.site);
  options.start = site.start;
  options.map = site.map.map;
  options.robot_radius_m = site.robot.radius_m;
  options.robot_footprint = site.robot.footprint;
  options.base.track_width_m = site.robot.track_width_m;
  return options;
}

ExitCode base_command(const BaseArguments& arguments) {
  if (arguments.dbc) {
    fmt::print("{}", dbc_of(protocol_of(arguments)));
    return done;
  }
  if (arguments.interface.empty())
    throw InputError("--can: found nothing, wanted the name of a CAN interface");
  HostedBase base(options_from(arguments));
  const Interruption interruption;
  log_info(fmt::format("a simulated base runs on {}; Ctrl-C ends it", arguments.interface));
  const HostedDrive drive = base.run([] { return Interruption::asked(); });
  const Pose2& end = drive.map_from_base;
  fmt::print("at {:.4f} {:.4f} {:.3f} driven {:.3f} contacts {}\n", end.position_m.x(), end.position_m.y(),
             degrees(end.yaw_rad), drive.driven_m, drive.contacts);
  return done;
}

}  // namespace

std::vector<Command> base_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<BaseArguments>();
  CLI::App* command = lodestar.add_subcommand(
      "base",
      "The simulated base on a CAN interface in real time, for any client; prints its true pose at the end");
  command->add_option("site", arguments->site, "Site folder to drive in; default: an unbounded empty floor");
  command->add_option("--can", arguments->interface, "CAN interface");
  command->add_option("--protocol", arguments->protocol, "agilex (V2) or odrive (CANSimple, nodes 0 and 1)")
      ->check(CLI::IsMember({"agilex", "odrive"}))
      ->capture_default_str();
  command->add_flag("--dbc", arguments->dbc, "Print the protocol as a .dbc file, and do nothing else");
  command->add_option("--world", arguments->world,
                      "The CAN interface of the navigator, when the base is at the other end of a cable");
  command->add_option("--seed", arguments->seed, "Seed of its wheel noise")->capture_default_str();
  command
      ->add_option("--watchdog", arguments->watchdog_s,
                   "Seconds without a message after which an ODrive's axes go idle with an error; 0: never")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  command
      ->add_option(
          "--fault", arguments->faults,
          "NAME@SECONDS[+SECONDS]: what goes wrong, when (after the first command that moves it), how long")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return {{command, [arguments] { return base_command(*arguments); }}};
}

}  // namespace lodestar
