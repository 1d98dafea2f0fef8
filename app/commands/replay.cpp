#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <memory>

#include "app/commands/charge_option.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/conducted_replay.hpp"
#include "app/commands/console_options.hpp"
#include "app/commands/console_service.hpp"
#include "app/commands/disturbance_options.hpp"
#include "app/commands/driven_survey.hpp"
#include "app/commands/explored_replay.hpp"
#include "app/commands/goal_lines.hpp"
#include "app/commands/goal_options.hpp"
#include "app/commands/kept_runs.hpp"
#include "app/commands/map_option.hpp"
#include "app/commands/people_options.hpp"
#include "app/commands/planner_options.hpp"
#include "app/commands/recorded_run.hpp"
#include "app/commands/repeated_replay.hpp"
#include "app/commands/ros2_service.hpp"
#include "app/commands/run_summary_json.hpp"
#include "app/common/interruption.hpp"
#include "app/common/json_text.hpp"
#include "app/common/log.hpp"
#include "app/common/program_data.hpp"
#include "app/common/progress.hpp"
#include "app/fleet/stop_actions.hpp"
#include "app/live/operator_session.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "app/simulate/fault_files.hpp"
#include "app/simulate/simulated_drive.hpp"
#include "app/site/arguments.hpp"
#include "app/site/route_graph.hpp"
#include "app/site/site_folder.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

struct ReplayArguments {
  std::string site;
  std::uint64_t seed = 1;
  int runs = 1;
  std::string camera;
  std::string planner = "fastest";
  GoalArguments goals;
  bool routes = false;
  bool charges = false;
  std::optional<double> battery_v;
  std::optional<double> pictures_hz;
  UncertaintyConstraintOptions uncertainty_constraint;
  DisturbanceArguments disturbances;
  PeopleArguments people;
  std::string faults;
  bool realtime = false;
  bool quiet = false;
  bool json = false;
  std::string state;
  std::string output;
  bool serve = false;
  bool survey = false;
  std::string map;
  bool explore = false;
  ConsoleServiceOptions console;
  FleetArguments fleet;
  Ros2Arguments ros2;
};

SimulatedDriveOptions replay_options(const ReplayArguments& arguments, const Site& site) {
  SimulatedDriveOptions options{.camera = arguments.camera.empty() ? site.default_camera : arguments.camera,
                                .seed = arguments.seed,
                                .goals = site.goals,
                                .planner = planner_kind(arguments.planner).value(),
                                .uncertainty_constraint = std::nullopt,
                                .disturbances = disturbances_of(arguments.disturbances),
                                .disk = std::make_shared<SimulatedDisk>(),
                                .battery_v = arguments.battery_v,
                                .pictures_hz = arguments.pictures_hz.value_or(arguments.serve ? 2.0 : 0.0),
                                .realtime = arguments.realtime};
  if (!arguments.faults.empty()) options.faults = faults_named(arguments.faults);
  if (!site.cameras.contains(options.camera)) {
    throw InputError(site.folder / "site.yaml", 0, "no camera '" + options.camera + "'",
                     "--camera to name one of its cameras");
  }
  if (arguments.uncertainty_constraint.wanted()) {
    const Visibility view = view_on_drives(site.map.map, site.registry, site.cameras.at(options.camera),
                                           visibility_options(site.robot), site.robot.radius_m);
    options.uncertainty_constraint = uncertainty_constraint(view, arguments.uncertainty_constraint);
  }
  if (!arguments.state.empty()) {
    StateFile file = load_state(arguments.state, state_owner(site, options.camera));
    if (!file.warning.empty()) fmt::print(stderr, "lodestar: warning: {}\n", file.warning);
    options.learned = std::move(file.state);
  }
  if (arguments.charges) options.goals.clear();
  if (!arguments.goals.empty()) options.goals = goals_in(arguments.goals, site.places);
  if (arguments.routes)
    options.goals =
        RouteGraph(site.places, site.robot.max_forward_mps).over_edges(site.start.position_m, options.goals);
  use_people(arguments.people, site, options);
  return options;
}

/// The command line that reproduces the run, byte for byte.
std::string repeat_command(const ReplayArguments& arguments, const SimulatedDriveOptions& options) {
  const std::string& site = arguments.site;
  std::string command =
      fmt::format("lodestar replay{} --seed {} --camera {} --planner {}", site.empty() ? "" : " " + site,
                  options.seed, options.camera, to_string(options.planner));
  command += words_of(arguments.uncertainty_constraint);
  command += words_of(arguments.goals, options.goals);
  if (arguments.routes) command += " --routes";
  if (arguments.charges) command += " --charge";
  if (arguments.battery_v) command += fmt::format(" --battery {}", *arguments.battery_v);
  if (!arguments.faults.empty()) command += " --faults " + arguments.faults;
  if (!arguments.map.empty()) command += " --build-map " + arguments.map;
  return command + words_of(arguments.people) + words_of(arguments.disturbances);
}

fs::path output_folder(const Site& site, const ReplayArguments& arguments) {
  if (!arguments.output.empty()) return arguments.output;
  return runs_folder() / fmt::format("{}-{}", site.name, arguments.seed);
}

DiskState disk_state(const SimulatedDisk& disk) {
  return {.is_full = [&disk] { return disk.full(); }, .delay = [&disk] { return disk.delay(); }};
}

ExitCode replay_once(const Site& site, SimulatedDriveOptions options, const ReplayArguments& arguments) {
  RecordedRun recorded(output_folder(site, arguments), site, options.camera,
                       {.seed = options.seed, .can_wait = true, .disk = disk_state(*options.disk)});
  const Interruption interruption;
  options.goes_on = [] { return !Interruption::asked(); };
  std::optional<Charging> charging;
  if (arguments.charges) {
    charging.emplace(charging_after(options.goals, site));
    attend_charging(options, *charging);
    options.stays_on = [&charging] { return charging->is_under_way(); };
  }
  RunRecord record;
  {
    Progress progress("replay", arguments.quiet);
    options.progress = [&progress](double share) { progress.show(share); };
    options.watch = recorded.watcher();
    record = simulate_drive(site, options);
  }
  if (!arguments.state.empty() && record.learned)
    save_state(*record.learned, state_owner(site, options.camera), arguments.state);
  record.repeat = repeat_command(arguments, options);
  const RunFolderEnd end = recorded.finish(record);
  if (!end.loss.empty())
    fmt::print(stderr, "lodestar: warning: the run is not recorded as a whole: {}\n", end.loss);
  RunSummary summary = summarize(record);
  if (options.has_people_or_things()) summary.people = record.contact_score;
  if (arguments.json) {
    fmt::print("{}", json_document(as_json(summary)));
  } else {
    print_goals(record);
    fmt::print("seed {}: {} contacts, 95 % of the track within {:.1f} mm of the path; run folder: {}\n",
               record.seed, record.contacts, 1000.0 * summary.path_p95_m,
               end.has_report ? recorded.folder().string() : "not written");
    if (summary.people)
      fmt::print("contacts while moving {}, excused {}, at rest {}\n", summary.people->moving,
                 summary.people->excused, summary.people->at_rest);
  }
  fmt::print(stderr, "{:.1f} s driven in {:.1f} s\n", summary.drive_s, summary.wall_s);
  if (arguments.survey) tell_next_step(site, recorded.folder());
  if (Interruption::asked() && !record.arrived()) {
    fmt::print(stderr, "lodestar: interrupted; the run folder has the drive up to here\n");
    return job_failed;
  }
  const bool is_charged = !charging || print_charge(*charging);
  return succeeded(summary) && is_charged && end.loss.empty() ? done : job_failed;
}

/// Simulates with the console in a browser, until Ctrl-C.
ExitCode replay_served(const Site& site, SimulatedDriveOptions options, const ReplayArguments& arguments) {
  check_tokens(arguments.console.access);
  const fs::path folder = output_folder(site, arguments);
  ConsoleServiceOptions console = arguments.console;
  console.site = site.folder;
  console.runs = fs::absolute(folder).parent_path();
  std::optional<DrivenSurvey> survey;
  if (arguments.survey) {
    survey.emplace(folder, site, options.camera, DrivenSurveyOptions{.can_wait = true});
    options.on_input = [&survey](const SensorInput& input) { survey->take(input); };
  }
  LiveLink link;
  ConsoleService service(console, &link, survey ? survey->live() : nullptr);
  OperatorSession session(link, [&service](const std::string& words) {
    log_info(words);
    service.note(words);
  });
  std::optional<Charging> charging = charging_of(site, true);
  if (charging) {
    session.use(*charging);
    attend_charging(options, *charging);
  }
  KeptRuns runs(folder, true, site, options.camera,
                {.seed = options.seed, .disk = disk_state(*options.disk)});
  if (!survey) options.watch = runs.watcher();
  bool all_arrived = true;

  const Interruption interruption;
  tell_address(console.access, service.port());
  const ConsoleThread thread(service);
  simulate_attended_drive(
      site, options, session, [] { return !Interruption::asked(); },
      [&](RunRecord record) {
        all_arrived = all_arrived && record.arrived();
        if (survey) return;
        if (runs.count() == 0) record.repeat = repeat_command(arguments, options);
        runs.keep(std::move(record));
      });
  const bool is_recorded = runs.finish() && (!survey || survey->finish());
  return all_arrived && is_recorded ? done : job_failed;
}

/// To see people, things and walls, and to be at fault itself.
bool needs_scanner(const ReplayArguments& arguments) {
  if (arguments.people.any() || !arguments.map.empty()) return true;
  return !arguments.faults.empty() &&
         std::ranges::any_of(faults_named(arguments.faults), concerns_scanner, &Fault::kind);
}

ExitCode replay_as_asked(const Site& site, const SimulatedDriveOptions& options,
                         const ReplayArguments& arguments) {
  if (arguments.explore) return replay_exploring(site, options, output_folder(site, arguments));
  if (arguments.fleet.is_wanted) return replay_in_fleet(site, options, arguments.fleet);
  if (arguments.serve) return replay_served(site, options, arguments);
  if (arguments.ros2.takes_commands && arguments.goals.empty()) return replay_waiting(site, options);
  if (arguments.runs == 1) return replay_once(site, options, arguments);
  return replay_many(
      site, options,
      {.runs = arguments.runs, .quiet = arguments.quiet, .json = arguments.json, .output = arguments.output});
}

ExitCode replay_command(const ReplayArguments& arguments) {
  Site site = open_site(arguments.site);
  if (needs_scanner(arguments) && !site.robot.scanner) site.robot.scanner.emplace();
  for (const std::string& warning : site.map.warnings) fmt::print(stderr, "lodestar: warning: {}\n", warning);
  SimulatedDriveOptions options = replay_options(arguments, site);
  Ros2Companion ros2(site, arguments.ros2, true);
  const bool many = arguments.runs > 1;
  if (many && std::ranges::any_of(options.goals, [](const Goal& goal) { return !goal.action.empty(); }))
    throw InputError(
        "--runs: found a mission with actions, wanted one run: its programs would run many times");
  options.realtime = options.realtime || arguments.ros2.is_wanted;  // tools of ROS look at it as it goes
  StopActions stops(site, !arguments.serve && !options.realtime, log_info);
  if (ros2.is_wanted() || !many) {
    options.attend = [&](const SensorInput& heard, const MissionStep& step, Mission& mission) {
      if (ros2.is_wanted()) ros2.attend(heard, step, mission);
      stops.attend(mission);
    };
  }
  const std::unique_ptr<LiveMap> map = live_map(
      arguments.map, site, fmt::format("lodestar replay, seed {},", options.seed), !options.realtime);
  if (map) attend_map(options, *map);
  const ExitCode code = replay_as_asked(site, options, arguments);
  const bool is_mapped = print_map(map.get());
  return ros2.finish() && is_mapped ? code : job_failed;
}

}  // namespace

std::vector<Command> replay_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<ReplayArguments>();
  CLI::App* command =
      lodestar.add_subcommand("replay", "Simulate a drive through a site; exit 1 unless the robot arrives");
  command->add_option(
      "site", arguments->site,
      "Site folder, or the name of a site in /etc/lodestar or /srv/lodestar; default: the lab");
  command->add_option("--seed", arguments->seed, "Seed of all randomness; the same seed gives the same bytes")
      ->capture_default_str();
  command
      ->add_option("--runs", arguments->runs,
                   "Number of runs, with this seed and the following ones, as a table")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--camera", arguments->camera, "One of the site's cameras; default: the one it names");
  command
      ->add_option("--planner", arguments->planner,
                   "fastest, anyangle, astar, rrtstar, informedrrtstar, bitstar, abitstar, prmstar")
      ->check(CLI::IsMember(planner_names()))
      ->capture_default_str();
  add_goal_options(*command, arguments->goals, "; default: the site's");
  add_charge_option(*command, arguments->charges);
  command
      ->add_option(
          "--battery", arguments->battery_v,
          "Volts of the simulated battery at rest at the start, 22 (empty) to 28.8 (full), where the "
          "site has a dock")
      ->check(CLI::Range(22.0, 28.8));
  command->add_flag("--routes", arguments->routes,
                    "Drive to the goals along the edges of places.yaml: one-way edges and their speeds hold");
  command
      ->add_option("--pictures", arguments->pictures_hz,
                   "Camera pictures per second to keep in the run folder; default: 2 with --serve, else none")
      ->check(CLI::Range(0.0, 100.0));
  add_uncertainty_constraint_options(*command, arguments->uncertainty_constraint);
  add_disturbance_options(*command, arguments->disturbances);
  add_people_options(*command, arguments->people);
  command->add_option("--faults", arguments->faults,
                      "Faults to inject: a file, or a name in the fault library such as wheel-slip");
  command
      ->add_option("--state", arguments->state,
                   "File with what earlier drives have learned of wheels, dots and displaced markers; read "
                   "before the drive and written after it")
      ->excludes(command->get_option("--runs"));
  command->add_flag("--realtime", arguments->realtime, "Simulate no faster than real time");
  CLI::Option* serve = command->add_flag(
      "--serve", arguments->serve, "Serve the console in a browser, and wait for goals from it until Ctrl-C");
  serve->excludes(command->get_option("--runs"))->excludes(command->get_option("--state"));
  for (const char* option : {"--runs", "--serve"})
    command->get_option("--charge")->excludes(command->get_option(option));
  command->add_flag("--survey", arguments->survey,
                    "The drive is a survey: says how to make a registry of it; with --serve one log for all "
                    "that is driven, by hand or by goals, and the console shows how it stands");
  command
      ->add_flag("--explore", arguments->explore,
                 "With --survey: the robot knows no marker, and drives by itself until it has surveyed all")
      ->needs(command->get_option("--survey"))
      ->excludes(serve)
      ->excludes(command->get_option("--runs"))
      ->excludes(command->get_option("--goal"))
      ->excludes(command->get_option("--charge"))
      ->excludes(command->get_option("--mission"));
  add_map_option(*command, arguments->map)->excludes(command->get_option("--runs"));
  CLI::Option* fleet = add_fleet_option(*command, arguments->fleet);
  for (const char* other :
       {"--runs", "--goal", "--mission", "--routes", "--charge", "--serve", "--survey", "--state"})
    fleet->excludes(command->get_option(other));
  add_ros2_options(*command, arguments->ros2);
  for (const char* option : {"--ros2", "--ros2-bag"})
    command->get_option(option)->excludes(command->get_option("--runs"));
  add_console_options(*command, arguments->console.access);
  add_lease_option(*command, arguments->console.live.lease);
  command->add_flag("--quiet", arguments->quiet, "No progress bar");
  command->add_flag("--json", arguments->json, "Results as JSON");
  command->add_option("-o,--output", arguments->output, "Run folder; default: runs/SITE-SEED");
  return {{command, [arguments] { return replay_command(*arguments); }}};
}

}  // namespace lodestar
