#include <memory>

#include "app/commands/command.hpp"
#include "app/commands/console_options.hpp"
#include "app/console/console.hpp"
#include "app/console/http_server.hpp"
#include "app/interruption.hpp"
#include "app/navigation_setup.hpp"
#include "app/viewers/drive_messages.hpp"
#include "app/viewers/foxglove_hub.hpp"

namespace lodestar {
namespace {

struct ServeArguments {
  std::string site;
  std::string runs = "runs";
  AccessRules access;
};

ExitCode serve(const ServeArguments& arguments) {
  check_tokens(arguments.access);
  Console console(arguments.site, arguments.runs);
  const Site site = load_site(arguments.site);
  FoxgloveHub viewers("Lodestar: " + site.name, drive_channels());
  for (const Message& message : scene_messages(known_world(site, site.default_camera), Stamp()))
    viewers.publish(message);
  HttpServer server(
      {.access = arguments.access}, [&](const HttpRequest& request) { return console.answer(request); },
      viewers.protocols());
  const Interruption interruption;
  tell_address(arguments.access, server.port());
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
  add_console_options(*command, arguments->access);
  return {{command, [arguments] { return serve(*arguments); }}};
}

}  // namespace lodestar
