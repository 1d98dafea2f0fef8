#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace lodestar {

/// What the shell gets back.
enum ExitCode : int { done = 0, job_failed = 1, unusable_input = 2 };

/// One word of the command line: its options, and what it does once they are read. run() throws InputError
/// for input that cannot be used.
struct Command {
  CLI::App* arguments = nullptr;
  std::function<ExitCode()> run;
};

std::vector<Command> replay_commands(CLI::App& lodestar);
std::vector<Command> campaign_commands(CLI::App& lodestar);
std::vector<Command> localize_commands(CLI::App& lodestar);
std::vector<Command> detect_commands(CLI::App& lodestar);
std::vector<Command> plan_commands(CLI::App& lodestar);
std::vector<Command> map_commands(CLI::App& lodestar);
std::vector<Command> markers_commands(CLI::App& lodestar);
std::vector<Command> marker_file_commands(CLI::App& markers);  ///< convert, print: words of `markers`
std::vector<Command> serve_commands(CLI::App& lodestar);
std::vector<Command> soak_commands(CLI::App& lodestar);
std::vector<Command> calibrate_commands(CLI::App& lodestar);
std::vector<Command> bench_commands(CLI::App& lodestar);
Command bench_localize_command(CLI::App& bench);
std::vector<Command> base_commands(CLI::App& lodestar);
std::vector<Command> run_commands(CLI::App& lodestar);
std::vector<Command> doctor_commands(CLI::App& lodestar);

}  // namespace lodestar
