#include <fmt/core.h>
#include <memory>

#include "app/commands/commands.hpp"
#include "app/placement/fill.hpp"
#include "app/placement/installation.hpp"
#include "app/placement/site_floor.hpp"
#include "app/site/site_folder.hpp"
#include "maps/atomic_file.hpp"
#include "maps/input_error.hpp"

// The subcommands of `lodestar markers` about where the markers of a site hang: fill and plan.
namespace lodestar {
namespace {

struct SiteFillArguments {
  std::string site;
  FillOptions options;
};

struct InstallationArguments {
  std::string site;
  std::string output;
  std::string date;
};

/// Keeps what is registered, and writes the registry anew only when markers are added.
ExitCode fill_site(const SiteFillArguments& arguments) {
  const Site site = open_site(arguments.site);
  const Filling filling = fill_gaps(site.registry, covered_floor(site), arguments.options);
  MarkerRegistry registry = site.registry;
  registry.markers.insert(registry.markers.end(), filling.added.begin(), filling.added.end());
  if (!filling.added.empty()) save_registry(registry, site.registry_file);
  fmt::print("{} markers added, {} in all in {}\n", filling.added.size(), registry.markers.size(),
             site.registry_file.string());
  if (filling.uncovered_m2 <= 0.0) return done;
  fmt::print(stderr, "lodestar: warning: {:.1f} m2 of the floor cannot see {} markers at every heading\n",
             filling.uncovered_m2, arguments.options.wanted);
  return done;
}

ExitCode write_installation(const InstallationArguments& arguments) {
  const Site site = open_site(arguments.site);
  const std::string text = installation_csv(site.registry, site.map.map, site.name, arguments.date);
  if (arguments.output.empty()) {
    fmt::print("{}", text);
  } else {
    write_file_atomically(arguments.output, text);
    fmt::print(stderr, "{} markers in {}\n", site.registry.markers.size(), arguments.output);
  }
  return done;
}

}  // namespace

std::vector<Command> marker_site_commands(CLI::App& markers) {
  const auto filled = std::make_shared<SiteFillArguments>();
  CLI::App* fill_command = markers.add_subcommand(
      "fill", "Add markers to a site until the robot sees enough of them wherever it can be");
  fill_command->add_option("site", filled->site, "Site folder")->required();
  fill_command->add_option("--ceiling", filled->options.ceiling_m, "Height of the new markers in metres")
      ->check(CLI::Range(0.5, 30.0))
      ->capture_default_str();
  fill_command->add_option("--in-view", filled->options.wanted, "Markers in view at every heading")
      ->check(CLI::Range(1, 6))
      ->capture_default_str();

  const auto planned = std::make_shared<InstallationArguments>();
  CLI::App* plan_command = markers.add_subcommand(
      "plan", "Installation table: place, height, yaw and the nearest walls of each marker, as CSV");
  plan_command->add_option("site", planned->site, "Site folder")->required();
  plan_command->add_option("-o,--output", planned->output, "CSV file; default: standard output");
  plan_command->add_option("--date", planned->date, "Date to write into the table");
  return {{fill_command, [filled] { return fill_site(*filled); }},
          {plan_command, [planned] { return write_installation(*planned); }}};
}

}  // namespace lodestar
