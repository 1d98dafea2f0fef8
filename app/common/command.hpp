#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace lodestar {

/// Exit status of the process.
enum ExitCode : int { done = 0, job_failed = 1, unusable_input = 2 };

/// A subcommand: its options, and what runs once they are parsed. run() throws InputError for unusable input.
struct Command {
  CLI::App* arguments = nullptr;
  std::function<ExitCode()> run;
};

}  // namespace lodestar
