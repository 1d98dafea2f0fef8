#include <ctime>
#include <filesystem>
#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands/commands.hpp"
#include "app/commands/console_options.hpp"
#include "app/commands/console_service.hpp"
#include "app/commands/goal_lines.hpp"
#include "app/commands/kept_runs.hpp"
#include "app/commands/planner_options.hpp"
#include "app/commands/recorded_run.hpp"
#include "app/common/interruption.hpp"
#include "app/common/log.hpp"
#include "app/common/progress.hpp"
#include "app/live/operator_session.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "app/simulate/fault_files.hpp"
#include "app/simulate/run_table.hpp"
#include "app/simulate/simulated_drive.hpp"
#include "app/simulate/simulated_drives.hpp"
#include "app/site/arguments.hpp"
#include "maps/atomic_file.hpp"
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
  std::vector<std::string> goals;
  std::optional<double> pictures_hz;
  UncertaintyConstraintOptions uncertainty_constraint;
  Disturbances disturbances;
  std::string faults;
  bool realtime = false;
  bool quiet = false;
  bool json = false;
  std::string output;
  bool serve = false;
  ConsoleServiceOptions console;
};

/// The lab site, from any working directory.
fs::path default_site() {
  const fs::path here = fs::path("sites") / "lab";
  return fs::exists(here / "site.yaml") ? here : fs::path(LODESTAR_SITES_DIR) / "lab";
}

SimulatedDriveOptions replay_options(const ReplayArguments& arguments, const Site& site) {
  SimulatedDriveOptions options{.camera = arguments.camera.empty() ? site.default_camera : arguments.camera,
                                .seed = arguments.seed,
                                .goals = site.goals,
                                .planner = planner_kind(arguments.planner).value(),
                                .uncertainty_constraint = std::nullopt,
                                .disturbances = arguments.disturbances,
                                .disk = std::make_shared<SimulatedDisk>(),
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
  if (arguments.goals.empty()) return options;
  options.goals.clear();
  for (const std::string& text : arguments.goals) options.goals.push_back(parse_goal("--goal", text));
  return options;
}

std::string disturbance_flags(const Disturbances& disturbances) {
  std::string flags;
  if (disturbances.lost_frames) flags += fmt::format(" --lose-frames {}", *disturbances.lost_frames);
  if (disturbances.unequal_wheels) flags += fmt::format(" --unequal-wheels {}", *disturbances.unequal_wheels);
  if (disturbances.removed_markers > 0.0)
    flags += fmt::format(" --remove-markers {}", disturbances.removed_markers);
  if (disturbances.plain_ceiling) flags += " --plain-ceiling";
  return flags;
}

/// The command line that reproduces the run, byte for byte.
std::string repeat_command(const ReplayArguments& arguments, const SimulatedDriveOptions& options) {
  const std::string& site = arguments.site;
  std::string command =
      fmt::format("lodestar replay{} --seed {} --camera {} --planner {}", site.empty() ? "" : " " + site,
                  options.seed, options.camera, to_string(options.planner));
  command += words_of(arguments.uncertainty_constraint);
  for (const Goal& goal : options.goals) {
    command += fmt::format(" --goal {},{}", goal.position_m.x(), goal.position_m.y());
    if (goal.heading_rad) command += fmt::format(",{:.9g}", degrees(*goal.heading_rad));
  }
  if (!arguments.faults.empty()) command += " --faults " + arguments.faults;
  return command + disturbance_flags(options.disturbances);
}

nlohmann::ordered_json as_json(const RunSummary& run) {
  return {{"seed", run.seed},
          {"goals", run.goals},
          {"arrivals", run.arrivals},
          {"worst_position_m", run.worst_position_m},
          {"worst_heading_deg", degrees(run.worst_heading_rad)},
          {"path_p95_m", run.path_p95_m},
          {"contacts", run.contacts},
          {"drive_s", run.drive_s},
          {"travel_s", run.travel_s},
          {"ideal_s", run.ideal_s},
          {"nees", run.nees},
          {"failure", run.failure}};
}

bool succeeded(const RunSummary& run) {
  return run.arrivals == run.goals && run.contacts == 0;
}

/// CPU time used so far, of all cores.
double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

ExitCode replay_many(const Site& site, const SimulatedDriveOptions& options,
                     const ReplayArguments& arguments) {
  const double begun_s = cpu_seconds();
  std::vector<RunSummary> runs;
  {
    Progress progress("replay", arguments.quiet);
    runs = simulate_drives(site, options, arguments.runs, [&](int finished) {
      progress.show(static_cast<double>(finished) / arguments.runs);
    });
  }
  nlohmann::ordered_json report = nlohmann::ordered_json::array();
  for (const RunSummary& run : runs) report.push_back(as_json(run));
  if (arguments.json) {
    fmt::print("{}\n", report.dump(2));
  } else {
    print_run_table(runs, cpu_seconds() - begun_s);
  }
  if (!arguments.output.empty()) {
    fs::create_directories(arguments.output);
    write_file_atomically(fs::path(arguments.output) / "runs.json", report.dump(2) + "\n");
  }
  return std::ranges::all_of(runs, succeeded) ? done : job_failed;
}

fs::path output_folder(const Site& site, const ReplayArguments& arguments) {
  if (!arguments.output.empty()) return arguments.output;
  return fs::path("runs") / fmt::format("{}-{}", site.name, arguments.seed);
}

DiskState disk_state(const SimulatedDisk& disk) {
  return {.is_full = [&disk] { return disk.full(); }, .delay = [&disk] { return disk.delay(); }};
}

ExitCode replay_once(const Site& site, SimulatedDriveOptions options, const ReplayArguments& arguments) {
  RecordedRun recorded(output_folder(site, arguments), site, options.camera,
                       {.can_wait = true, .disk = disk_state(*options.disk)});
  RunRecord record;
  {
    Progress progress("replay", arguments.quiet);
    options.progress = [&progress](double share) { progress.show(share); };
    options.watch = recorded.watcher();
    record = simulate_drive(site, options);
  }
  record.repeat = repeat_command(arguments, options);
  const RunFolderEnd end = recorded.finish(record);
  if (!end.loss.empty())
    fmt::print(stderr, "lodestar: warning: the run is not recorded as a whole: {}\n", end.loss);
  const RunSummary summary = summarize(record);
  if (arguments.json) {
    fmt::print("{}\n", as_json(summary).dump(2));
  } else {
    print_goals(record);
    fmt::print("seed {}: {} contacts, 95 % of the track within {:.1f} mm of the path; run folder: {}\n",
               record.seed, record.contacts, 1000.0 * summary.path_p95_m,
               end.has_report ? recorded.folder().string() : "not written");
  }
  fmt::print(stderr, "{:.1f} s driven in {:.1f} s\n", summary.drive_s, summary.wall_s);
  return succeeded(summary) && end.loss.empty() ? done : job_failed;
}

/// Simulates with the console in a browser, until Ctrl-C.
ExitCode replay_served(const Site& site, SimulatedDriveOptions options, const ReplayArguments& arguments) {
  check_tokens(arguments.console.access);
  const fs::path folder = output_folder(site, arguments);
  ConsoleServiceOptions console = arguments.console;
  console.site = site.folder;
  console.runs = fs::absolute(folder).parent_path();
  LiveLink link;
  ConsoleService service(console, &link);
  OperatorSession session(link, log_info);
  KeptRuns runs(folder, true, site, options.camera, {.disk = disk_state(*options.disk)});
  options.watch = runs.watcher();
  bool all_arrived = true;

  const Interruption interruption;
  tell_address(console.access, service.port());
  const ConsoleThread thread(service);
  simulate_attended_drive(
      site, options, session, [] { return !Interruption::asked(); },
      [&](RunRecord record) {
        all_arrived = all_arrived && record.arrived();
        if (runs.count() == 0) record.repeat = repeat_command(arguments, options);
        runs.keep(std::move(record));
      });
  return all_arrived ? done : job_failed;
}

ExitCode replay_command(const ReplayArguments& arguments) {
  const Site site = load_site(arguments.site.empty() ? default_site() : fs::path(arguments.site));
  for (const std::string& warning : site.map.warnings) fmt::print(stderr, "lodestar: warning: {}\n", warning);
  const SimulatedDriveOptions options = replay_options(arguments, site);
  if (arguments.serve) return replay_served(site, options, arguments);
  return arguments.runs > 1 ? replay_many(site, options, arguments) : replay_once(site, options, arguments);
}

}  // namespace

std::vector<Command> replay_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<ReplayArguments>();
  CLI::App* command =
      lodestar.add_subcommand("replay", "Simulate a drive through a site; exit 1 unless the robot arrives");
  command->add_option("site", arguments->site, "Site folder; default: the lab");
  command->add_option("--seed", arguments->seed, "Seed of all randomness; the same seed gives the same bytes")
      ->capture_default_str();
  command
      ->add_option("--runs", arguments->runs,
                   "Number of runs, with this seed and the following ones, as a table")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--camera", arguments->camera, "wide or paper; default: the site's")
      ->check(CLI::IsMember({"wide", "paper"}));
  command
      ->add_option("--planner", arguments->planner,
                   "fastest, anyangle, astar, rrtstar, informedrrtstar, bitstar, abitstar, prmstar")
      ->check(CLI::IsMember(planner_names()))
      ->capture_default_str();
  command
      ->add_option("--goal", arguments->goals,
                   "X,Y[,DEG] in metres and degrees; repeat for more; default: the site's")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      ->add_option("--pictures", arguments->pictures_hz,
                   "Camera pictures per second to keep in the run folder; default: 2 with --serve, else none")
      ->check(CLI::Range(0.0, 100.0));
  add_uncertainty_constraint_options(*command, arguments->uncertainty_constraint);
  const auto share = CLI::Range(0.0, 1.0);
  command
      ->add_option("--lose-frames", arguments->disturbances.lost_frames, "Share of frames that never arrive")
      ->check(share);
  command
      ->add_option(
          "--unequal-wheels", arguments->disturbances.unequal_wheels,
          "Share by which the left wheel rolls farther than the right one for the same encoder reading")
      ->check(CLI::Range(-0.2, 0.2));
  command
      ->add_option("--remove-markers", arguments->disturbances.removed_markers,
                   "Share of markers missing from the ceiling, drawn from the seed; those nearest to start "
                   "and goals stay")
      ->check(share);
  command->add_flag("--plain-ceiling", arguments->disturbances.plain_ceiling,
                    "Nothing on the ceiling but markers: no joints, stains or lamps");
  command->add_option("--faults", arguments->faults,
                      "Faults to inject: a file, or a name in the fault library such as wheel-slip");
  command->add_flag("--realtime", arguments->realtime, "Simulate no faster than real time");
  CLI::Option* serve = command->add_flag(
      "--serve", arguments->serve, "Serve the console in a browser, and wait for goals from it until Ctrl-C");
  serve->excludes(command->get_option("--runs"));
  add_console_options(*command, arguments->console.access);
  add_lease_option(*command, arguments->console.live.lease);
  command->add_flag("--quiet", arguments->quiet, "No progress bar");
  command->add_flag("--json", arguments->json, "Results as JSON");
  command->add_option("-o,--output", arguments->output, "Run folder; default: runs/SITE-SEED");
  return {{command, [arguments] { return replay_command(*arguments); }}};
}

}  // namespace lodestar
