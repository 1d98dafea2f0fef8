#pragma once

namespace lodestar {

/// All of the program `lodestar`: does what its arguments ask for and returns the process's exit code.
int program(int argc, char** argv);

}  // namespace lodestar
