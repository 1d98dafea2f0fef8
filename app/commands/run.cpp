#include "app/run.hpp"

#include <csignal>
#include <filesystem>
#include <fmt/core.h>
#include <memory>

#include "app/arguments.hpp"
#include "app/base_setup.hpp"
#include "app/commands/command.hpp"
#include "app/commands/console_options.hpp"
#include "app/commands/kept_runs.hpp"
#include "app/console/console_service.hpp"
#include "app/frames/camera_setup.hpp"
#include "app/live/attendant.hpp"
#include "app/navigation_setup.hpp"
#include "app/operator_input.hpp"
#include "app/report/run_folder.hpp"
#include "app/viewers/run_mcap.hpp"
#include "drivers/guard.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

volatile std::sig_atomic_t told_to_stop = 0;

void take_signal(int /*signal*/) {
  told_to_stop = 1;
}

struct RunArguments {
  std::string site;
  std::vector<std::string> goals;
  std::string interface;
  std::uint64_t seed = 1;
  std::string output;
  double pictures_hz = 2.0;
  bool serve = false;
  std::string runs = "runs";
  ConsoleServiceOptions console;
};

GuardOptions guard_options(const BaseProtocol& protocol) {
  GuardOptions options;
  options.stop = protocol.stop();
  options.bus.identifiers = protocol.identifiers();
  return options;
}

OperatorWish wish_of(OperatorInput& input) {
  if (told_to_stop != 0) return OperatorWish::stop;
  const auto word = input.poll();
  if (!word) return OperatorWish::none;
  return *word == OperatorWord::resume ? OperatorWish::resume : OperatorWish::stop;
}

void print_goals(const RunRecord& record) {
  for (const GoalRecord& goal : record.goals) {
    const Vec2& at = goal.goal.position_m;
    if (goal.arrived) {
      fmt::print("({:.2f}, {:.2f}): reached after {:.1f} s\n", at.x(), at.y(), seconds(goal.travel_time));
    } else {
      fmt::print("({:.2f}, {:.2f}): not reached: {}\n", at.x(), at.y(),
                 goal.failure.empty() ? "never started" : goal.failure);
    }
  }
}

/// The console beside a robot that drives, and where its drives are kept.
class ServedRun {
 public:
  ServedRun(const Site& site, const RunArguments& arguments, RunOptions& options)
      : service_(console_options(site, arguments), &link_),
        runs_(arguments.output.empty() ? fs::path(arguments.runs) / site.name : fs::path(arguments.output),
              !arguments.output.empty(), site, options.camera) {
    options.watch = [this](const DriveMoment& moment) { runs_.watch(moment); };
    options.attendant = &attendant_;
    options.hold_on_base_fault = true;
    options.keep = [this](RunRecord record) { keep(std::move(record)); };
    tell_address(arguments.console.access, service_.port());
    thread_.emplace(service_);
  }

  void keep(RunRecord record) {
    if (record.goals.empty()) return;
    all_arrived_ = all_arrived_ && record.arrived();
    runs_.keep(std::move(record));
  }
  [[nodiscard]] bool all_arrived() const { return all_arrived_; }

 private:
  static ConsoleServiceOptions console_options(const Site& site, const RunArguments& arguments) {
    check_tokens(arguments.console.access);
    ConsoleServiceOptions options = arguments.console;
    options.site = site.folder;
    options.runs =
        arguments.output.empty() ? fs::path(arguments.runs) : fs::absolute(arguments.output).parent_path();
    return options;
  }

  LiveLink link_;
  Attendant attendant_{link_};
  ConsoleService service_;
  KeptRuns runs_;
  bool all_arrived_ = true;
  std::optional<ConsoleThread> thread_;  // ends before what it serves
};

ExitCode run_command(const RunArguments& arguments) {
  if (arguments.goals.empty() && !arguments.serve) throw InputError("found neither --goal nor --serve");
  const Site site = load_site(arguments.site);
  const BaseConnection connection = connection_of(site, arguments.interface);
  OperatorInput input;
  RunOptions options{.camera = site.default_camera,
                     .goals = {},
                     .pictures_hz = arguments.pictures_hz,
                     .hold_on_base_fault = true,
                     .operator_wish = [&input] { return wish_of(input); },
                     .tell = [](const std::string& words) { fmt::print(stderr, "{}\n", words); }};
  for (const std::string& text : arguments.goals) options.goals.push_back(parse_goal("--goal", text));
  (void)input.poll();
  options.hold_on_base_fault = input.is_there();

  std::unique_ptr<BaseProtocol> protocol = make_protocol(connection, site.robot);
  GuardedBus bus(connection.interface, guard_options(*protocol));
  const std::unique_ptr<Camera> camera = open_camera(site, connection, arguments.seed);
  std::signal(SIGINT, take_signal);
  std::signal(SIGTERM, take_signal);
  std::optional<ServedRun> served;
  if (arguments.serve) served.emplace(site, arguments, options);
  std::optional<RunMcap> mcap;
  if (!arguments.output.empty() && !served) {
    mcap.emplace(arguments.output, known_world(site, options.camera), site.robot.radius_m);
    options.watch = [&mcap](const DriveMoment& moment) { mcap->watch(moment); };
  }
  RunRecord record = run(site, bus, std::move(protocol), *camera, options);
  if (served) {
    served->keep(std::move(record));
    return served->all_arrived() ? done : job_failed;
  }
  if (!arguments.output.empty()) write_run_folder(arguments.output, record, site.map.map, site.registry);
  if (mcap && !mcap->healthy())
    fmt::print(stderr, "lodestar: warning: the disk did not take all of run.mcap\n");
  print_goals(record);
  return record.arrived() ? done : job_failed;
}

}  // namespace

std::vector<Command> run_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<RunArguments>();
  CLI::App* command =
      lodestar.add_subcommand("run",
                              "Drive the robot of a site to one goal after the other; exit 1 unless it "
                              "arrives. After a fault it waits "
                              "for the line 'resume' (or 'stop') on standard input, if that is open");
  command->add_option("site", arguments->site, "Site folder")->required();
  command->add_option("--goal", arguments->goals, "X,Y[,DEG] in metres and degrees; repeat for more")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_flag("--serve", arguments->serve,
                    "Show it in a browser, and wait there for goals until it is stopped");
  command->add_option("--runs", arguments->runs, "With --serve: folder for run folders, unless -o names one")
      ->capture_default_str();
  add_console_options(*command, arguments->console.access);
  add_lease_option(*command, arguments->console.live.lease);
  command->add_option("--can", arguments->interface, "CAN interface; the site's when left out");
  command->add_option("--seed", arguments->seed, "Of a simulated camera")->capture_default_str();
  command
      ->add_option("--pictures", arguments->pictures_hz, "Camera pictures a second to keep in the run folder")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command->add_option("-o,--output", arguments->output, "Leave a run folder");
  return {{command, [arguments] { return run_command(*arguments); }}};
}

}  // namespace lodestar
