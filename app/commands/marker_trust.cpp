#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <memory>

#include "app/commands/commands.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "app/site/site_folder.hpp"
#include "maps/marker.hpp"

// `lodestar markers trust`: a person has hung a marker back where it was surveyed.
namespace lodestar {
namespace {

struct TrustArguments {
  std::string site;
  std::vector<int> ids;
  std::filesystem::path state;
};

ExitCode trust(const TrustArguments& arguments) {
  const Site site = open_site(arguments.site);
  const std::filesystem::path file = arguments.state.empty() ? state_file(site) : arguments.state;
  const std::vector<int> trusted = trust_again(file, arguments.ids);
  if (!trusted.empty()) fmt::print("trusted again: {}\n", fmt::join(trusted, ", "));
  for (const int id : arguments.ids)
    if (std::ranges::find(trusted, id) == trusted.end())
      fmt::print(stderr, "lodestar: warning: {}: marker {} is not distrusted\n", file.string(), id);
  return trusted.empty() ? job_failed : done;
}

}  // namespace

Command marker_trust_command(CLI::App& markers) {
  const auto arguments = std::make_shared<TrustArguments>();
  CLI::App* command = markers.add_subcommand("trust",
                                             "Trust markers again that drives found displaced, once they "
                                             "hang as surveyed; not while the robot drives");
  command->add_option("site", arguments->site, "Site folder")->required();
  command->add_option("ids", arguments->ids, "IDs of the markers")
      ->required()
      ->check(CLI::Range(0, marker_id_count - 1));
  command->add_option("--state", arguments->state, "State file of the robot's drives; default: the site's");
  return {command, [arguments] { return trust(*arguments); }};
}

}  // namespace lodestar
