#pragma once

#include <CLI/CLI.hpp>

#include "app/net/access.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// Adds --port, --bind and the token options of commands that serve the console.
void add_console_options(CLI::App& command, AccessRules& access);

/// Adds --lease of commands that serve a robot.
void add_lease_option(CLI::App& command, Duration& lease);

/// Throws InputError for a token of fewer than 16 characters, which could be guessed.
void check_tokens(const AccessRules& access);

/// Prints the console's address on standard output, and how to use a token on standard error.
void tell_address(const AccessRules& access, unsigned short port);

}  // namespace lodestar
