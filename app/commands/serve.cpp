#include <memory>

#include "app/commands/commands.hpp"
#include "app/commands/console_options.hpp"
#include "app/commands/console_service.hpp"
#include "app/common/interruption.hpp"
#include "app/common/program_data.hpp"
#include "app/site/site_folder.hpp"

namespace lodestar {
namespace {

ExitCode serve(ConsoleServiceOptions options) {
  check_tokens(options.access);
  options.site = site_folder(options.site.string());
  if (options.runs.empty()) options.runs = runs_folder();
  ConsoleService service(options, nullptr);
  const Interruption interruption;
  tell_address(options.access, service.port());
  while (!Interruption::asked()) service.serve_a_turn();
  return done;
}

}  // namespace

std::vector<Command> serve_commands(CLI::App& lodestar) {
  const auto options = std::make_shared<ConsoleServiceOptions>();
  CLI::App* command = lodestar.add_subcommand("serve",
                                              "Serve the console in a browser: edit markers on the map, see "
                                              "their coverage, print them, play back runs");
  command
      ->add_option("site", options->site,
                   "Site folder, or the name of a site in /etc/lodestar or /srv/lodestar")
      ->required();
  command->add_option(
      "--runs", options->runs,
      "Folder with run folders; default: runs, or where replay writes if that may not be written");
  add_console_options(*command, options->access);
  return {{command, [options] { return serve(*options); }}};
}

}  // namespace lodestar
