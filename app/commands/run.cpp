#include "app/drive/run.hpp"

#include <chrono>
#include <filesystem>
#include <fmt/chrono.h>
#include <fmt/core.h>
#include <memory>

#include "app/commands/charge_option.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/console_options.hpp"
#include "app/commands/console_service.hpp"
#include "app/commands/driven_survey.hpp"
#include "app/commands/fleet_service.hpp"
#include "app/commands/goal_lines.hpp"
#include "app/commands/goal_options.hpp"
#include "app/commands/kept_runs.hpp"
#include "app/commands/localizing_run.hpp"
#include "app/commands/map_option.hpp"
#include "app/commands/ros2_service.hpp"
#include "app/commands/served_run.hpp"
#include "app/common/interruption.hpp"
#include "app/common/log.hpp"
#include "app/common/program_data.hpp"
#include "app/common/wall_clock.hpp"
#include "app/drive/camera_setup.hpp"
#include "app/drive/operator_input.hpp"
#include "app/fleet/stop_actions.hpp"
#include "app/placement/exploration.hpp"
#include "app/site/arguments.hpp"
#include "app/site/base_setup.hpp"
#include "app/site/site_folder.hpp"
#include "drivers/base/guard.hpp"
#include "drivers/system/service_manager.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

struct RunArguments {
  std::string site;
  GoalArguments goals;
  bool charges = false;
  std::string interface;
  std::uint64_t seed = 1;
  std::string output;
  double pictures_hz = 2.0;
  bool serve = false;
  bool survey = false;
  std::string map;
  bool explore = false;
  std::string runs;
  std::string state;
  ConsoleServiceOptions console;
  FleetArguments fleet;
  Ros2Arguments ros2;
  bool localize_only = false;
  std::string odometry = "base";
};

GuardOptions guard_options(const BaseProtocol& protocol) {
  GuardOptions options;
  options.stop = protocol.stop();
  options.bus.identifiers = protocol.identifiers();
  return options;
}

OperatorWish wish_of(OperatorInput& input) {
  if (Interruption::asked()) return OperatorWish::stop;
  const auto word = input.poll();
  if (!word) return OperatorWish::none;
  return *word == OperatorWord::resume ? OperatorWish::resume : OperatorWish::stop;
}

/// The run folder of this drive.
fs::path run_folder(const RunArguments& arguments, const Site& site) {
  if (!arguments.output.empty()) return arguments.output;
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return runs_folder() / fmt::format("{}-{:%Y%m%dT%H%M%SZ}", site.name, now);
}

/// Everything a drive needs besides its options.
struct DriveParts {
  const Site& site;
  CanBus& bus;
  const std::string& interface;
  Camera& camera;
};

ServedRunOptions served_options(const DriveParts& parts, const RunArguments& arguments) {
  return {.console = arguments.console,
          .output = arguments.output,
          .runs = arguments.runs,
          .interface = parts.interface};
}

/// Drives to the goals, if any, and goes on looking until it is told to stop.
ExitCode drive_surveying(const DriveParts& parts, std::unique_ptr<BaseProtocol> protocol, RunOptions options,
                         const RunArguments& arguments) {
  std::optional<PlacedStart> start;
  if (arguments.explore) start = PlacedStart{.map_from_base = parts.site.start};
  DrivenSurvey survey(run_folder(arguments, parts.site), parts.site, options.camera, {.start = start});
  auto explored = ExplorationState::done;
  std::optional<Exploration> exploration;
  if (start) {
    exploration.emplace(parts.site, options.camera, *start);
    options.conduct = [&](const MissionStep& step, Mission& mission) {
      explored = exploration->conduct(step, mission, survey.live()->newest().get());
      return explored == ExplorationState::under_way;
    };
  }
  options.on_input = [&survey](const SensorInput& input) { survey.take(input); };
  bool all_arrived = true;
  if (arguments.serve) {
    ServedRun served(parts.site, served_options(parts, arguments), options, &survey);
    served.keep(run(parts.site, parts.bus, std::move(protocol), parts.camera, options));
    all_arrived = served.succeeded();
  } else {
    options.until_stopped = arguments.goals.empty() && !exploration;
    const RunRecord record = run(parts.site, parts.bus, std::move(protocol), parts.camera, options);
    print_goals(record);
    all_arrived = record.goals.empty() || record.arrived();
  }
  if (exploration) tell_shortcomings(*exploration, survey.live()->newest().get());
  const bool is_recorded = survey.finish();
  return all_arrived && is_recorded && explored == ExplorationState::done ? done : job_failed;
}

ExitCode drive_once(const DriveParts& parts, std::unique_ptr<BaseProtocol> protocol, RunOptions options,
                    const RunArguments& arguments) {
  KeptRuns runs(run_folder(arguments, parts.site), true, parts.site, options.camera,
                {.interface = parts.interface});
  options.watch = runs.watcher();
  std::optional<Charging> charging;
  if (arguments.charges) {
    charging.emplace(charging_after(options.goals, parts.site));
    attend_charging(options, *charging);
    options.conduct = [&charging](const MissionStep&, const Mission& mission) {
      return !mission.finished() || charging->is_under_way();
    };
  }
  RunRecord record = run(parts.site, parts.bus, std::move(protocol), parts.camera, options);
  print_goals(record);
  const bool has_arrived = record.arrived();
  runs.keep(std::move(record));
  const bool is_recorded = runs.finish();
  const bool is_charged = !charging || print_charge(*charging);
  return has_arrived && is_charged && is_recorded ? done : job_failed;
}

/// Drives with the console, until it is told to stop.
ExitCode drive_served(const DriveParts& parts, std::unique_ptr<BaseProtocol> protocol, RunOptions options,
                      const RunArguments& arguments, Charging* of_fleet = nullptr) {
  ServedRun served(parts.site, served_options(parts, arguments), options, nullptr);
  std::optional<Charging> charging;
  if (of_fleet != nullptr) {
    served.use(*of_fleet);
  } else if (charging = charging_of(parts.site, true); charging) {
    served.use(*charging);
    attend_charging(options, *charging);
  }
  served.keep(run(parts.site, parts.bus, std::move(protocol), parts.camera, options));
  return served.succeeded() ? done : job_failed;
}

/// Drives by a fleet manager's orders until it is told to stop; with the console, if that is wanted.
ExitCode drive_in_fleet(const DriveParts& parts, std::unique_ptr<BaseProtocol> protocol, RunOptions options,
                        const RunArguments& arguments) {
  FleetService fleet(parts.site, fleet_settings(parts.site, arguments.fleet, false));
  options.hold_on_base_fault = true;
  options.on_input = [&fleet](const SensorInput& input) { fleet.session().hear(input); };
  options.conduct = [&fleet](const MissionStep& step, Mission& mission) {
    fleet.session().attend(step, mission);
    return true;
  };
  if (arguments.serve)
    return drive_served(parts, std::move(protocol), options, arguments, fleet.session().charging());
  (void)run(parts.site, parts.bus, std::move(protocol), parts.camera, options);
  return done;
}

void check_purpose(const RunArguments& arguments) {
  const bool is_given_goals = !arguments.goals.empty() || arguments.charges || arguments.fleet.is_wanted ||
                              arguments.ros2.takes_commands;
  if (!is_given_goals && !arguments.serve && !arguments.survey && !arguments.localize_only)
    throw InputError(
        "found neither --goal, --mission, --charge, --serve, --fleet, --ros2-commands, --localize-only nor "
        "--survey");
  if (arguments.localize_only && !arguments.ros2.is_wanted)
    throw InputError("--localize-only: found no --ros2, wanted it: the pose has nowhere to go");
}

ExitCode drive_as_asked(const DriveParts& parts, std::unique_ptr<BaseProtocol> protocol,
                        const RunOptions& options, const RunArguments& arguments) {
  if (arguments.fleet.is_wanted) return drive_in_fleet(parts, std::move(protocol), options, arguments);
  if (arguments.survey) return drive_surveying(parts, std::move(protocol), options, arguments);
  if (!arguments.serve && !arguments.charges &&
      arguments.goals.empty()) {  // by topic alone, until it is told to stop
    (void)run(parts.site, parts.bus, std::move(protocol), parts.camera, options);
    return done;
  }
  return arguments.serve ? drive_served(parts, std::move(protocol), options, arguments)
                         : drive_once(parts, std::move(protocol), options, arguments);
}

ExitCode run_command(RunArguments arguments) {
  check_purpose(arguments);
  if (arguments.runs.empty()) arguments.runs = runs_folder();
  Site site = open_site(arguments.site);
  if (arguments.explore) site.registry = {};
  for (const std::string& warning : site.map.warnings) fmt::print(stderr, "lodestar: warning: {}\n", warning);
  OperatorInput input;
  if (arguments.localize_only)
    return run_localizing(site,
                          {.ros2 = arguments.ros2,
                           .reads_odometry = arguments.odometry == "ros2",
                           .interface = arguments.interface,
                           .seed = arguments.seed},
                          [&input] { return wish_of(input); });
  const BaseConnection connection = connection_of(site, arguments.interface);
  ServiceManager manager(service_environment());
  RunOptions options{.camera = site.default_camera,
                     .goals = {},
                     .pictures_hz = arguments.pictures_hz,
                     .hold_on_base_fault = true,
                     .operator_wish = [&input] { return wish_of(input); },
                     .tell =
                         [&manager](Severity severity, const std::string& words) {
                           program_log().say(severity, words);
                           if (severity != Severity::debug) manager.tell_status(words);
                         },
                     .on_end = [&manager] { manager.stop(); },
                     .on_step = [&manager](Stamp now) { manager.step(now); },
                     .state = arguments.state};
  options.goals = goals_in(arguments.goals, site.places);
  (void)input.poll();
  options.hold_on_base_fault = input.is_there();

  std::unique_ptr<BaseProtocol> protocol = make_protocol(connection, site.robot);
  GuardedBus bus(connection.interface, guard_options(*protocol));
  const std::unique_ptr<Camera> camera = open_camera(site, connection, arguments.seed);
  const std::unique_ptr<Scanner> scanner = scanner_of(site);
  options.scanner = scanner.get();
  const std::unique_ptr<DepthCamera> depth_camera = depth_camera_of(site);
  options.depth_camera = depth_camera.get();
  Ros2Companion ros2(site, arguments.ros2, false);
  StopActions stops(site, false, log_info);
  options.attend = [&](const SensorInput& heard, const MissionStep& step, Mission& mission) {
    if (ros2.is_wanted()) ros2.attend(heard, step, mission);
    stops.attend(mission);
  };
  options.until_stopped = arguments.ros2.takes_commands;
  const std::unique_ptr<LiveMap> map =
      live_map(arguments.map, site, fmt::format("lodestar run {}, begun {},", site.name, utc_text()), false);
  if (map) attend_map(options, *map);
  const Interruption interruption;
  const DriveParts parts{.site = site, .bus = bus, .interface = connection.interface, .camera = *camera};
  const ExitCode code = drive_as_asked(parts, std::move(protocol), options, arguments);
  const bool is_mapped = print_map(map.get());
  return ros2.finish() && is_mapped ? code : job_failed;
}

}  // namespace

std::vector<Command> run_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = lodestar.add_subcommand("run",
                                              "Drive a site's robot to its goals in turn; exit 1 unless it "
                                              "arrives and is recorded. After a fault it waits for the "
                                              "line 'resume' (or 'stop') on standard input, if that is open");
  command
      ->add_option("site", arguments->site,
                   "Site folder, or the name of a site in /etc/lodestar or /srv/lodestar")
      ->required();
  add_goal_options(*command, arguments->goals);
  CLI::Option* charge = add_charge_option(*command, arguments->charges);
  command->add_flag("--serve", arguments->serve,
                    "Serve the console in a browser, and wait for goals from it until stopped");
  command->add_flag(
      "--survey", arguments->survey,
      "Keep what a survey needs of all that the robot sees, and show it in the console: driven by "
      "hand there (with --serve), by goals, or by the base's own remote control until stopped");
  command
      ->add_flag(
          "--explore", arguments->explore,
          "With --survey: put at the site's start, under a marker, the robot drives by itself over the free "
          "floor of the map until it has surveyed every marker there")
      ->needs(command->get_option("--survey"))
      ->excludes(command->get_option("--mission"))
      ->excludes(command->get_option("--goal"));
  command->add_option("--runs", arguments->runs,
                      "With --serve: folder for run folders, unless -o names one; default: runs");
  add_fleet_option(*command, arguments->fleet)
      ->excludes(command->get_option("--goal"))
      ->excludes(command->get_option("--mission"))
      ->excludes(charge)
      ->excludes(command->get_option("--survey"));
  charge->excludes(command->get_option("--serve"))->excludes(command->get_option("--survey"));
  add_ros2_options(*command, arguments->ros2);
  CLI::Option* only =
      command->add_flag("--localize-only", arguments->localize_only,
                        "Publish where the robot is, for another program that drives it: commands "
                        "nothing, and sends nothing to the base");
  for (const char* other :
       {"--goal", "--mission", "--charge", "--serve", "--survey", "--fleet", "--ros2-commands"})
    only->excludes(command->get_option(other));
  command
      ->add_option("--odom", arguments->odometry, "Of --localize-only: base (its CAN) or ros2 (topic odom)")
      ->needs(only)
      ->check(CLI::IsMember({"base", "ros2"}))
      ->capture_default_str();
  add_console_options(*command, arguments->console.access);
  add_lease_option(*command, arguments->console.live.lease);
  command->add_option(
      "--state", arguments->state,
      "File of what drives learn of wheels, dots and displaced markers; default: state.yaml of the site");
  add_map_option(*command, arguments->map)->excludes(only);
  command->add_option("--can", arguments->interface, "CAN interface; default: the site's");
  command->add_option("--seed", arguments->seed, "Seed of a simulated camera")->capture_default_str();
  command
      ->add_option("--pictures", arguments->pictures_hz,
                   "Camera pictures per second to keep in the run folder")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command->add_option("-o,--output", arguments->output, "Run folder; default: runs/SITE-TIME");
  return {{command, [arguments] { return run_command(*arguments); }}};
}

}  // namespace lodestar
