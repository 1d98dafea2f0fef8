#include <fmt/core.h>
#include <memory>

#include "app/commands/command.hpp"
#include "app/console/console.hpp"
#include "app/console/http_server.hpp"
#include "app/interruption.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

struct ServeArguments {
  std::string site;
  std::string runs = "runs";
  AccessRules access{.bind = "127.0.0.1", .port = 8440};
};

ExitCode serve(const ServeArguments& arguments) {
  constexpr std::size_t shortest_token = 16;
  const std::string& token = arguments.access.token;
  if (!token.empty() && token.size() < shortest_token) {
    throw InputError(
        fmt::format("--token: found {} characters, wanted {} or more", token.size(), shortest_token));
  }
  Console console(arguments.site, arguments.runs);
  HttpServer server({.access = arguments.access},
                    [&](const HttpRequest& request) { return console.answer(request); });
  const Interruption interruption;
  fmt::print("http://{}:{}/\n", arguments.access.bind, server.port());
  std::fflush(stdout);
  if (!token.empty()) fmt::print(stderr, "append #t=TOKEN to that address once in each browser\n");
  while (!Interruption::asked()) server.run_for(std::chrono::milliseconds(200));
  return done;
}

}  // namespace

std::vector<Command> serve_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<ServeArguments>();
  CLI::App* command = lodestar.add_subcommand(
      "serve", "The console in a browser: edit markers on the map, see what they cover, print them");
  command->add_option("site", arguments->site, "Site folder")->required();
  command->add_option("--runs", arguments->runs, "Folder with run folders, as replay -o leaves them")
      ->capture_default_str();
  command->add_option("--port", arguments->access.port, "0 takes any free one")->capture_default_str();
  command
      ->add_option("--bind", arguments->access.bind,
                   "Address to listen on; any other than loopback needs a token")
      ->capture_default_str();
  command->add_option("--token", arguments->access.token, "Who does not have it is turned away")
      ->envname("LODESTAR_TOKEN");
  return {{command, [arguments] { return serve(*arguments); }}};
}

}  // namespace lodestar
