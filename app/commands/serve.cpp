#include <memory>

#include "app/commands/commands.hpp"
#include "app/commands/console_options.hpp"
#include "app/commands/console_service.hpp"
#include "app/common/interruption.hpp"
#include "app/common/program_data.hpp"
#include "app/console/new_site_api.hpp"
#include "app/site/site_folder.hpp"

namespace lodestar {
namespace {

constexpr int turns_for_the_answer = 40;  // of 50 ms, before the server that gave it makes way for another

struct ServeArguments {
  ConsoleServiceOptions console;
  bool is_new = false;
};

/// Serves the page that makes the site, on the port where its console will be; false when it was not made.
bool serve_new_site(const ServeArguments& arguments, AccessRules& access) {
  constexpr std::size_t most_plan_bytes = 64U << 20U;
  constexpr std::chrono::milliseconds turn(50);
  NewSiteApi api(arguments.console.site, program_data("sites/lab"),
                 arguments.console.runs.empty() ? runs_folder() : arguments.console.runs);
  HttpServer server(
      {.access = access, .max_body_bytes = most_plan_bytes, .uses_files = NewSiteApi::uses_files},
      [&api](const HttpRequest& request) { return api.answer(request); });
  access.port = server.port();
  tell_address(access, server.port());
  while (!api.is_made() && !Interruption::asked()) server.run_for(turn);
  for (int i = 0; i < turns_for_the_answer && api.is_made(); ++i) server.run_for(turn);
  return api.is_made();
}

ExitCode serve(const ServeArguments& arguments) {
  ConsoleServiceOptions options = arguments.console;
  check_tokens(options.access);
  const Interruption interruption;
  if (arguments.is_new && !serve_new_site(arguments, options.access)) return done;
  options.site = site_folder(options.site.string());
  if (options.runs.empty()) options.runs = runs_folder();
  options.may_change_map = true;
  bool is_told = arguments.is_new;
  while (!Interruption::asked()) {
    ConsoleService service(options, nullptr);
    options.access.port = service.port();
    if (!std::exchange(is_told, true)) tell_address(options.access, service.port());
    while (!Interruption::asked() && !service.has_new_map()) service.serve_a_turn();
    for (int i = 0; i < turns_for_the_answer && service.has_new_map(); ++i) service.serve_a_turn();
  }
  return done;
}

}  // namespace

std::vector<Command> serve_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<ServeArguments>();
  ConsoleServiceOptions& console = arguments->console;
  CLI::App* command = lodestar.add_subcommand("serve",
                                              "Serve the console in a browser: edit markers on the map, see "
                                              "their coverage, print them, play back runs");
  command
      ->add_option("site", console.site,
                   "Site folder, or the name of a site in /etc/lodestar or /srv/lodestar")
      ->required();
  command->add_flag("--new", arguments->is_new,
                    "The folder is not there yet: the page makes it, from a plan or from nothing");
  command->add_option(
      "--runs", console.runs,
      "Folder with run folders; default: runs, or where replay writes if that may not be written");
  add_console_options(*command, console.access);
  return {{command, [arguments] { return serve(*arguments); }}};
}

}  // namespace lodestar
