#include "app/commands/program.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fmt/core.h>
#include <opencv2/core/utility.hpp>
#include <opencv2/core/utils/logger.hpp>

#include "app/commands/commands.hpp"
#include "app/commands/strict_arguments.hpp"
#include "app/common/log.hpp"
#include "app/hosting/hosting.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

std::vector<Command> all_commands(CLI::App& app) {
  std::vector<Command> all;
  for (const auto make :
       {replay_commands,      campaign_commands, soak_commands,     localize_commands, detect_commands,
        plan_commands,        map_commands,      site_commands,     markers_commands,  places_commands,
        calibrate_commands,   survey_commands,   bench_commands,    base_commands,     scanner_commands,
        run_commands,         fleet_commands,    scenario_commands, doctor_commands,   serve_commands,
        command_line_commands}) {
    for (Command& command : make(app)) all.push_back(std::move(command));
  }
  return all;
}

/// Of the commands that say something while they run.
void add_log_option(CLI::App& app) {
  std::vector<CLI::App*> talkers{app.get_subcommand("fleet")->get_subcommand("demo")};
  for (const char* name : {"run", "serve", "replay", "base", "scanner", "soak"})
    talkers.push_back(app.get_subcommand(name));
  for (CLI::App* command : talkers) {
    command
        ->add_option_function<std::string>(
            "--log-level",
            [](const std::string& level) { program_log().set_least(severity_named(level).value()); },
            "What to say on standard error while it runs: debug, info, warning or error; info when left out")
        ->check(CLI::IsMember({"debug", "info", "warning", "error"}))
        ->envname("LODESTAR_LOG_LEVEL");
  }
}

ExitCode run_chosen(const std::vector<Command>& commands) {
  for (const Command& command : commands) {
    if (command.arguments->parsed()) return command.run();
  }
  return unusable_input;  // unreachable: a subcommand is required
}

int run_program(int argc, char** argv) {
  cv::setNumThreads(1);  // no hidden threads: parallelism is arranged by in_parallel()
  cv::utils::logging::setLogLevel(
      cv::utils::logging::LOG_LEVEL_SILENT);  // errors are reported by this program
  CLI::App app{"Indoor navigation for mobile robots under a ceiling of infrared dot markers", "lodestar"};
  app.set_version_flag("--version", LODESTAR_VERSION);
  app.require_subcommand(1);
  const std::vector<Command> commands = all_commands(app);
  add_log_option(app);
  refuse_unusual_numbers(app);
  if (const std::optional<std::string> unknown = unknown_command(app, argc, argv)) {
    fmt::print(stderr, "lodestar: {}\n", *unknown);
    return unusable_input;
  }
  try {
    app.parse(argc, argv);
    return run_chosen(commands);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? done : unusable_input;
  } catch (const InputError& error) {
    fmt::print(stderr, "lodestar: {}\n", error.what());
    return unusable_input;
  } catch (const std::exception& error) {
    fmt::print(stderr, "lodestar: internal error: {}\n", error.what());
    return job_failed;
  }
}

}  // namespace

int program(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // beyond a limit to files, writing fails as on a full disk
  const int exit_code = run_program(argc, argv);
  const bool is_printed = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (is_printed) return exit_code;
  fmt::print(stderr, "lodestar: not all of the output could be written ({})\n", std::strerror(errno));
  return exit_code == done ? job_failed : exit_code;
}

}  // namespace lodestar
