#include "app/run.hpp"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fmt/chrono.h>
#include <fmt/core.h>
#include <memory>

#include "app/arguments.hpp"
#include "app/base_setup.hpp"
#include "app/commands/command.hpp"
#include "app/frames/camera_setup.hpp"
#include "app/operator_input.hpp"
#include "app/report/can_log.hpp"
#include "app/report/run_folder.hpp"
#include "drivers/guard.hpp"
#include "drivers/recorded_bus.hpp"
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

void say(const std::string& words) {
  fmt::print(stderr, "{}\n", words);
}

/// The folder that this drive leaves, made already: what it cannot hold shall be known before the drive.
fs::path make_run_folder(const RunArguments& arguments, const Site& site) {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  const fs::path folder = arguments.output.empty()
                              ? fs::path("runs") / fmt::format("{}-{:%Y%m%dT%H%M%SZ}", site.name, now)
                              : fs::path(arguments.output);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    say(fmt::format("{}: cannot be made ({}); this drive is not kept", folder.string(), error.message()));
  return folder;
}

/// A drive that is over does not fail for want of room on a disk.
void keep(const RunRecord& record, const Site& site, const fs::path& folder) {
  try {
    write_run_folder(folder, record, site.map.map, site.registry);
  } catch (const InputError& error) {
    say(fmt::format("the run folder is not complete: {}", error.what()));
  }
}

ExitCode run_command(const RunArguments& arguments) {
  const Site site = load_site(arguments.site);
  const BaseConnection connection = connection_of(site, arguments.interface);
  OperatorInput input;
  RunOptions options{.camera = site.default_camera,
                     .goals = {},
                     .hold_on_base_fault = true,
                     .operator_wish = [&input] { return wish_of(input); },
                     .tell = say};
  for (const std::string& text : arguments.goals) options.goals.push_back(parse_goal("--goal", text));
  (void)input.poll();
  options.hold_on_base_fault = input.is_there();

  std::unique_ptr<BaseProtocol> protocol = make_protocol(connection, site.robot);
  GuardedBus bus(connection.interface, guard_options(*protocol));
  const std::unique_ptr<Camera> camera = open_camera(site, connection, arguments.seed);
  std::signal(SIGINT, take_signal);
  std::signal(SIGTERM, take_signal);
  const fs::path folder = make_run_folder(arguments, site);
  const RunRecord record = [&] {
    CanLog log(folder / "can.log", connection.interface, say);
    RecordedBus logged(bus, [&log](const StampedCanFrame& frame) { log.take(frame); });
    return run(site, logged, std::move(protocol), *camera, options);
  }();
  keep(record, site, folder);
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
      ->required()
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--can", arguments->interface, "CAN interface; the site's when left out");
  command->add_option("--seed", arguments->seed, "Of a simulated camera")->capture_default_str();
  command->add_option("-o,--output", arguments->output, "Run folder; runs/SITE-TIME when left out");
  return {{command, [arguments] { return run_command(*arguments); }}};
}

}  // namespace lodestar
