#pragma once

namespace lodestar {

/// The program `lodestar`: runs the subcommand of its arguments and returns the exit status.
int program(int argc, char** argv);

}  // namespace lodestar
