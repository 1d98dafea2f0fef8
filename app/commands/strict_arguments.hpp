#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

namespace lodestar {

/// From now on all options of the command line that are numbers, also those of subcommands, refuse what only
/// resembles one: "nan" and "inf", which pass every comparison with a range, "-1" and 2^64 where a whole
/// number would wrap or saturate.
void refuse_unusual_numbers(CLI::App& app);

/// What to say when the first argument names no command, with the name that it resembles. Nothing for a
/// command, an option, or no argument.
std::optional<std::string> unknown_command(const CLI::App& app, int argc, char** argv);

}  // namespace lodestar
