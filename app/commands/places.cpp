#include <algorithm>
#include <chrono>
#include <fmt/chrono.h>
#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands/commands.hpp"
#include "app/common/json_text.hpp"
#include "app/placement/lif.hpp"
#include "app/placement/places_check.hpp"
#include "maps/atomic_file.hpp"
#include "maps/file_text.hpp"

namespace lodestar {
namespace {

struct PlacesArguments {
  std::string site;
  bool json = false;
  std::string file;
  LifChoice choice;
};

void print_json(const Places& places, const std::vector<PlacesIssue>& issues) {
  nlohmann::ordered_json report{{"places", places.places.size()},
                                {"nodes", places.nodes.size()},
                                {"edges", places.edges.size()},
                                {"keep_out", places.keep_out.size()},
                                {"speed_zones", places.speed_zones.size()},
                                {"issues", nlohmann::ordered_json::array()}};
  for (const PlacesIssue& issue : issues) report["issues"].push_back(issue_json(issue));
  fmt::print("{}", json_document(report));
}

void print_text(const Site& site, const std::vector<PlacesIssue>& issues) {
  const std::string file = (site.folder / places_file_name).string();
  for (const PlacesIssue& issue : issues)
    fmt::print("{}: {}: {}\n", file, issue.error ? "error" : "warning", issue.words);
  const Places& places = site.places;
  fmt::print("{} places, {} nodes, {} edges, {} keep-outs, {} speed zones\n", places.places.size(),
             places.nodes.size(), places.edges.size(), places.keep_out.size(), places.speed_zones.size());
}

ExitCode check_site_places(const PlacesArguments& arguments) {
  const Site site = load_site(arguments.site);
  const std::vector<PlacesIssue> issues = check_places(site);
  if (arguments.json) {
    print_json(site.places, issues);
  } else {
    print_text(site, issues);
  }
  return std::ranges::any_of(issues, &PlacesIssue::error) ? job_failed : done;
}

ExitCode export_lif(const PlacesArguments& arguments) {
  const Site site = load_site(arguments.site);
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  const LifHeader header{.project = site.name,
                         .vehicle_type = site.robot.name,
                         .exported_at = fmt::format("{:%Y-%m-%dT%H:%M:%S.00Z}", now)};
  const std::string text = json_document(lif_of(site.places, header));
  if (arguments.file.empty()) {
    fmt::print("{}", text);
  } else {
    write_file_atomically(arguments.file, text);
  }
  return done;
}

/// Replaces the graph; zones stay, and so do missions, whose places must still be there.
ExitCode import_lif(const PlacesArguments& arguments) {
  const Site site = load_site(arguments.site);
  ImportedLif lif = read_lif(file_text(arguments.file, "a LIF file"), arguments.file, arguments.choice);
  for (const std::string& warning : lif.warnings) fmt::print(stderr, "lodestar: warning: {}\n", warning);
  Places places = site.places;
  places.places = std::move(lif.places.places);
  places.nodes = std::move(lif.places.nodes);
  places.edges = std::move(lif.places.edges);
  save_places(parse_places(places_text(places), "the places with those of " + arguments.file), site.folder);
  fmt::print("{} places, {} nodes, {} edges\n", places.places.size(), places.nodes.size(),
             places.edges.size());
  return done;
}

}  // namespace

std::vector<Command> places_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<PlacesArguments>();
  CLI::App* places = lodestar.add_subcommand(
      "places", "Check a site's named places, zones and route graph, and exchange the graph");
  places->require_subcommand(1);
  CLI::App* check = places->add_subcommand("check",
                                           "Name places, start and goals where the robot cannot stand or "
                                           "which it cannot reach from the others, and "
                                           "edges that are blocked; exit 1 when there are any");
  check->add_option("site", arguments->site, "Site folder")->required();
  check->add_flag("--json", arguments->json, "As JSON");

  CLI::App* exported = places->add_subcommand(
      "export", "Write places, nodes and edges as a LIF 1.0.0 file for a fleet manager");
  exported->add_option("site", arguments->site, "Site folder")->required();
  exported->add_option("-o,--output", arguments->file, "LIF file; default: standard output");

  CLI::App* imported = places->add_subcommand(
      "import", "Replace places, nodes and edges by those of a LIF file; zones and missions stay");
  imported->add_option("site", arguments->site, "Site folder")->required();
  imported->add_option("lif", arguments->file, "LIF file")->required();
  imported->add_option("--layout", arguments->choice.layout,
                       "ID of the layout; needed when there are several");
  imported->add_option("--vehicle-type", arguments->choice.vehicle_type,
                       "ID of the vehicle type; default: the first of each node and edge");
  return {{check, [arguments] { return check_site_places(*arguments); }},
          {exported, [arguments] { return export_lif(*arguments); }},
          {imported, [arguments] { return import_lif(*arguments); }}};
}

}  // namespace lodestar
