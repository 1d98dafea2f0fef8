#include "app/commands/console_options.hpp"

#include <fmt/core.h>

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

}  // namespace

void add_console_options(CLI::App& command, AccessRules& access) {
  access.port = usual_port;
  command.add_option("--port", access.port, "Port of the console; 0: any free one")->capture_default_str();
  command.add_option("--bind", access.bind, "Address to listen on; any other than loopback needs a token")
      ->capture_default_str();
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
