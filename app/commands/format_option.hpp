#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace lodestar {

/// --format, one of the choices; `format` has the default. Where JSON is among them also --json, which every
/// command understands that can print it. `format` must outlive the command line.
void add_format_option(CLI::App& command, std::string& format, const std::vector<std::string>& choices,
                       const std::string& description);

}  // namespace lodestar
