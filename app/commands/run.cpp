#include "app/run.hpp"

#include <csignal>
#include <filesystem>
#include <fmt/core.h>
#include <memory>

#include "app/arguments.hpp"
#include "app/base_setup.hpp"
#include "app/commands/command.hpp"
#include "app/frames/camera_setup.hpp"
#include "app/operator_input.hpp"
#include "app/report/run_folder.hpp"
#include "drivers/guard.hpp"

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

ExitCode run_command(const RunArguments& arguments) {
  const Site site = load_site(arguments.site);
  const BaseConnection connection = connection_of(site, arguments.interface);
  OperatorInput input;
  RunOptions options{.camera = site.default_camera,
                     .goals = {},
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
  const RunRecord record = run(site, bus, std::move(protocol), *camera, options);
  print_goals(record);
  if (!arguments.output.empty())
    (void)leave_run_folder(arguments.output, record, site.map.map, site.registry);
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
  command->add_option("-o,--output", arguments->output, "Leave a run folder");
  return {{command, [arguments] { return run_command(*arguments); }}};
}

}  // namespace lodestar
