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

}  // namespace lodestar
