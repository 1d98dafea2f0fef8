#include "app/commands/console_options.hpp"

#include <array>
#include <fmt/core.h>
#include <unistd.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

constexpr unsigned short usual_port = 8440;

void check_token(const char* option, const std::string& token) {
  constexpr std::size_t shortest_token = 16;
  if (token.empty() || token.size() >= shortest_token) return;
  throw InputError(
      fmt::format("{}: found {} characters, wanted {} or more", option, token.size(), shortest_token));
}

/// As a browser sends it: letters, digits, dots and dashes, in lower case.
std::string host_name_in(const std::string& option) {
  std::string name;
  for (const char c : option) {
    const bool is_upper = c >= 'A' && c <= 'Z';
    if (!is_upper && !(c >= 'a' && c <= 'z') && !(c >= '0' && c <= '9') && c != '-' && c != '.')
      throw CLI::ValidationError("--host-name", fmt::format("found '{}', wanted a host name", option));
    name += is_upper ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return name;
}

/// This machine's own name, plain and as multicast DNS has it. No foreign page has it.
std::vector<std::string> own_host_names() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0 || name[0] == '\0') return {};
  try {
    const std::string own = host_name_in(name.data());
    return {own, own + ".local"};
  } catch (const CLI::ValidationError&) {
    return {};
  }
}

}  // namespace

void add_console_options(CLI::App& command, AccessRules& access) {
  access.port = usual_port;
  command.add_option("--port", access.port, "Port of the console; 0: any free one")->capture_default_str();
  command.add_option("--bind", access.bind, "Address to listen on; any other than loopback needs a token")
      ->capture_default_str();
  access.host_names = own_host_names();
  command
      .add_option_function<std::vector<std::string>>(
          "--host-name",
          [&access](const std::vector<std::string>& names) {
            for (const std::string& name : names) access.host_names.push_back(host_name_in(name));
          },
          "Another name by which browsers may call this machine, besides its own; may be given again")
      ->allow_extra_args(false);
  command.add_option("--token", access.token, "Token that permits everything: view, edit and drive")
      ->envname("LODESTAR_TOKEN");
  command.add_option("--edit-token", access.edit_token, "Token that permits to view and edit")
      ->envname("LODESTAR_EDIT_TOKEN");
  command.add_option("--view-token", access.view_token, "Token that permits to view, and to stop the robot")
      ->envname("LODESTAR_VIEW_TOKEN");
}

void add_lease_option(CLI::App& command, Duration& lease) {
  command
      .add_option_function<double>(
          "--lease", [&lease](double lease_s) { lease = from_seconds(lease_s); },
          "Seconds after which the robot pauses when its driver is silent; default: 1")
      ->check(CLI::Range(0.3, 60.0));
}

void check_tokens(const AccessRules& access) {
  check_token("--token", access.token);
  check_token("--edit-token", access.edit_token);
  check_token("--view-token", access.view_token);
}

void tell_address(const AccessRules& access, unsigned short port) {
  fmt::print("http://{}:{}/\n", access.bind, port);
  std::fflush(stdout);
  if (access.asks_for_token()) fmt::print(stderr, "append #t=TOKEN to that address once in each browser\n");
}

}  // namespace lodestar
