#include "app/commands/format_option.hpp"

#include <algorithm>

namespace lodestar {

void add_format_option(CLI::App& command, std::string& format, const std::vector<std::string>& choices,
                       const std::string& description) {
  CLI::Option* option = command.add_option("--format", format, description)
                            ->check(CLI::IsMember(choices))
                            ->capture_default_str();
  if (std::ranges::find(choices, "json") == choices.end()) return;
  command.add_flag_callback(
             "--json", [&format] { format = "json"; }, "The same as --format json")
      ->excludes(option);
}

}  // namespace lodestar
