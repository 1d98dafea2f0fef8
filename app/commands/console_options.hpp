#pragma once

#include <CLI/CLI.hpp>

#include "app/net/access.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// --port, --bind and the tokens of whoever serves the console.
void add_console_options(CLI::App& command, AccessRules& access);

/// --lease of whoever serves a robot.
void add_lease_option(CLI::App& command, Duration& lease);

/// Throws InputError for a token so short that it can be guessed.
void check_tokens(const AccessRules& access);

/// Tells the console's address on standard output, and on standard error what to do with a token.
void tell_address(const AccessRules& access, unsigned short port);

}  // namespace lodestar
