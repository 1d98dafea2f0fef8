#pragma once

#include <vector>

#include "app/common/command.hpp"

namespace lodestar {

// The subcommands of the command line, each in a file of its own.
std::vector<Command> replay_commands(CLI::App& lodestar);
std::vector<Command> campaign_commands(CLI::App& lodestar);
std::vector<Command> localize_commands(CLI::App& lodestar);
std::vector<Command> detect_commands(CLI::App& lodestar);
std::vector<Command> plan_commands(CLI::App& lodestar);
std::vector<Command> map_commands(CLI::App& lodestar);
std::vector<Command> markers_commands(CLI::App& lodestar);
std::vector<Command> places_commands(CLI::App& lodestar);
std::vector<Command> site_commands(CLI::App& lodestar);
std::vector<Command> marker_file_commands(CLI::App& markers);  ///< convert, print: subcommands of `markers`
std::vector<Command> marker_site_commands(CLI::App& markers);  ///< fill, plan: subcommands of `markers`
Command map_build_command(CLI::App& map);
Command marker_trust_command(CLI::App& markers);
std::vector<Command> serve_commands(CLI::App& lodestar);
std::vector<Command> soak_commands(CLI::App& lodestar);
std::vector<Command> calibrate_commands(CLI::App& lodestar);
std::vector<Command> bench_commands(CLI::App& lodestar);
Command bench_localize_command(CLI::App& bench);
Command bench_survey_command(CLI::App& bench);
std::vector<Command> fleet_commands(CLI::App& lodestar);
std::vector<Command> run_commands(CLI::App& lodestar);
std::vector<Command> scenario_commands(CLI::App& lodestar);
std::vector<Command> survey_commands(CLI::App& lodestar);
std::vector<Command> doctor_commands(CLI::App& lodestar);
std::vector<Command> command_line_commands(CLI::App& lodestar);  ///< last: it describes those before it

}  // namespace lodestar
