#include <fmt/core.h>
#include <memory>
#include <numeric>

#include "app/commands/commands.hpp"
#include "app/commands/fleet_service.hpp"
#include "app/common/interruption.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "app/simulate/fleet_starts.hpp"
#include "app/simulate/simulated_fleet.hpp"
#include "app/site/site_folder.hpp"

namespace lodestar {
namespace {

struct FleetDemoArguments {
  int robots = 0;
  std::string site;
  std::string broker;
  std::uint64_t seed = 1;
  double apart_m = 1.0;
};

/// Each under a serial number of its own: the site's, or its name, and -1, -2 ...
std::vector<std::unique_ptr<FleetService>> services_for(const Site& site,
                                                        const FleetDemoArguments& arguments) {
  const FleetSettings settings = fleet_settings(site, {.is_wanted = true, .broker = arguments.broker}, true);
  std::vector<std::unique_ptr<FleetService>> services;
  for (int i = 1; i <= arguments.robots; ++i) {
    FleetSettings own = settings;
    own.serial = fmt::format("{}-{}", settings.serial, i);
    services.push_back(std::make_unique<FleetService>(site, own, own.serial));
    fmt::print("{}/{}\n", own.manufacturer, own.serial);
  }
  std::fflush(stdout);
  return services;
}

ExitCode fleet_demo(const FleetDemoArguments& arguments) {
  const Site site = open_site(arguments.site);
  SimulatedDriveOptions options;
  options.camera = site.default_camera;
  options.seed = arguments.seed;
  const std::vector<Pose2> starts = fleet_starts(site, options.camera, arguments.robots, arguments.apart_m);
  const std::vector<std::unique_ptr<FleetService>> services = services_for(site, arguments);
  std::vector<FleetRobot> robots;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    FleetSession& session = services[i]->session();
    robots.push_back({.start = starts[i],
                      .on_input = [&session](const SensorInput& input) { session.hear(input); },
                      .conduct = [&session](const MissionStep& step,
                                            Mission& mission) { session.attend(step, mission); }});
  }
  const Interruption interruption;
  const std::vector<ConductedDrive> driven =
      simulate_fleet(site, options, robots, [] { return !Interruption::asked(); });
  int touches = 0;
  for (std::size_t i = 0; i < driven.size(); ++i) {
    fmt::print("robot {}: {:.1f} m driven, {} contacts\n", i + 1, driven[i].driven_m, driven[i].touches);
    touches += driven[i].touches;
  }
  return touches == 0 ? done : job_failed;
}

}  // namespace

std::vector<Command> fleet_commands(CLI::App& lodestar) {
  CLI::App* fleet = lodestar.add_subcommand("fleet", "Robots in a fleet");
  fleet->require_subcommand(1);
  const auto arguments = std::make_shared<FleetDemoArguments>();
  CLI::App* demo = fleet->add_subcommand(
      "demo",
      "Simulate robots in one world that drive by the orders of a VDA 5050 fleet manager, until "
      "Ctrl-C; prints manufacturer/serial of each; exit 1 where one of them touched anything");
  demo->add_option("robots", arguments->robots, "How many")->required()->check(CLI::Range(1, 100));
  demo->add_option("site", arguments->site,
                   "Site folder, or the name of a site in /etc/lodestar or /srv/lodestar; default: the lab");
  demo->add_option(
      "--broker", arguments->broker,
      "The MQTT broker's address, mqtts://HOST[:PORT]; mqtt:// on this machine; default: the site's");
  demo->add_option("--seed", arguments->seed, "Of the first robot's randomness; the others' follow")
      ->capture_default_str();
  demo->add_option("--apart", arguments->apart_m, "Metres between the robots at the start")
      ->check(CLI::Range(0.1, 100.0))
      ->capture_default_str();
  return {{demo, [arguments] { return fleet_demo(*arguments); }}};
}

}  // namespace lodestar
