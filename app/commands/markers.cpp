#include <algorithm>
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands/commands.hpp"
#include "app/commands/format_option.hpp"
#include "app/common/json_text.hpp"
#include "app/placement/accepted_issues.hpp"
#include "app/placement/coverage.hpp"
#include "app/placement/site_floor.hpp"
#include "app/site/site_folder.hpp"
#include "maps/input_error.hpp"
#include "maps/map_file.hpp"
#include "maps/marker.hpp"
#include "maps/marker_code.hpp"
#include "maps/marker_registry.hpp"

namespace lodestar {
namespace {

struct MarkersArguments {
  std::string registry;
  std::string map;
  std::string site;
  std::string format = "text";
};

struct GenerateArguments {
  int count = 0;
  MarkerCodeOptions code;
  bool plain = false;
  std::string avoid;
  std::string format = "ids";
};

nlohmann::ordered_json as_json(const MarkerRegistry& registry, const RegisteredMarker& marker) {
  const Eigen::Isometry3d pose = map_from_marker(registry, marker);
  return {{"id", marker.id},
          {"x_m", pose.translation().x()},
          {"y_m", pose.translation().y()},
          {"z_m", pose.translation().z()},
          {"yaw_deg", degrees(flattened(pose).yaw_rad)},
          {"dots", dots_of(marker.id).size()},
          {"line", marker.line}};
}

void print_marker(const std::string& format, const nlohmann::ordered_json& m) {
  const auto row = format == "csv" ? "{},{:.6f},{:.6f},{:.6f},{:.4f},{}\n"
                                   : "{:>5} {:>9.3f} {:>9.3f} {:>7.3f} {:>8.1f} {:>5}\n";
  fmt::print(fmt::runtime(row), m["id"].get<int>(), m["x_m"].get<double>(), m["y_m"].get<double>(),
             m["z_m"].get<double>(), m["yaw_deg"].get<double>(), m["dots"].get<int>());
}

/// Poses are in the map frame: the registry's alignment is applied.
ExitCode list(const MarkersArguments& arguments) {
  const MarkerRegistry registry = load_registry(arguments.registry);
  if (arguments.format == "csv") fmt::print("id,x_m,y_m,z_m,yaw_deg,dots\n");
  if (arguments.format == "text") fmt::print("   id       x_m       y_m     z_m  yaw_deg  dots\n");
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const RegisteredMarker& marker : registry.markers) {
    if (arguments.format == "json") {
      all.push_back(as_json(registry, marker));
    } else {
      print_marker(arguments.format, as_json(registry, marker));
    }
  }
  if (arguments.format == "json") fmt::print("{}", json_document(all));
  return done;
}

nlohmann::ordered_json as_json(const DistanceReport& report) {
  nlohmann::ordered_json pairs = nlohmann::ordered_json::array();
  for (const MarkerPair& pair : report.closest_pairs)
    pairs.push_back({{"ids", {pair.first, pair.second}}, {"apart_m", pair.apart_m}});
  return {{"smallest_distance", report.smallest}, {"closest_pairs", pairs}};
}

void print_json(const MarkerRegistry& registry, const std::vector<RegistryIssue>& issues,
                const std::vector<AcceptedIssue>& accepted) {
  nlohmann::ordered_json report{{"markers", registry.markers.size()},
                                {"upright", as_json(upright_distances(registry))},
                                {"turned_or_mirrored", as_json(turned_distances(registry))},
                                {"issues", nlohmann::ordered_json::array()}};
  for (const RegistryIssue& issue : issues) report["issues"].push_back(issue_json(issue, accepted));
  fmt::print("{}", json_document(report));
}

void print_distances(const char* how, const DistanceReport& report) {
  if (report.closest_pairs.empty()) return;
  const std::size_t pairs = report.closest_pairs.size();
  fmt::print("{}: the closest markers differ in {} of the 16 cells ({} {})\n", how, report.smallest, pairs,
             pairs == 1 ? "pair" : "pairs");
  constexpr std::size_t enough = 10;
  for (std::size_t i = 0; i < std::min(enough, pairs); ++i) {
    const MarkerPair& pair = report.closest_pairs[i];
    if (pair.first == pair.second) {
      fmt::print("  {} and itself\n", pair.first);
    } else {
      fmt::print("  {} and {}, {:.2f} m apart\n", pair.first, pair.second, pair.apart_m);
    }
  }
  if (pairs > enough) fmt::print("  ... and {} more (--json lists all)\n", pairs - enough);
}

void print_text(const std::string& file, const MarkerRegistry& registry,
                const std::vector<RegistryIssue>& issues, const std::vector<AcceptedIssue>& accepted) {
  std::vector<std::string> standing;
  for (const RegistryIssue& issue : issues) {
    if (const AcceptedIssue* by = acceptance_of(issue, accepted)) {
      standing.push_back(fmt::format("  {}: {}", issue.words, by->reason));
      continue;
    }
    const std::string line = issue.line > 0 ? fmt::format("{}:", issue.line) : "";
    fmt::print("{}:{} {}: {}\n", file, line, issue.error ? "error" : "warning", issue.words);
  }
  fmt::print("{} markers\n", registry.markers.size());
  if (!standing.empty()) fmt::print("let stand by {}:\n{}\n", accepted_file_name, fmt::join(standing, "\n"));
  print_distances("upright", upright_distances(registry));
  print_distances("turned or mirrored", turned_distances(registry));
}

/// Checks the named registry, or else the site's own.
ExitCode check(const MarkersArguments& arguments) {
  if (arguments.registry.empty() && arguments.site.empty())
    throw InputError("found neither a registry nor --site, wanted one of them at least");
  std::optional<Site> site;
  if (!arguments.site.empty()) site = open_site(arguments.site);
  const std::string file = arguments.registry.empty() ? site->registry_file.string() : arguments.registry;
  const MarkerRegistry registry = load_registry_draft(file);
  std::optional<OccupancyMap> map;
  if (!arguments.map.empty()) map = load_map(arguments.map).map;
  const std::vector<RegistryIssue> issues =
      site ? check_coverage(registry, covered_floor(*site)) : check_registry(registry, map);
  const std::vector<AcceptedIssue> accepted =
      site ? load_accepted(site->folder) : std::vector<AcceptedIssue>{};
  if (arguments.format == "json") {
    print_json(registry, issues, accepted);
  } else {
    print_text(file, registry, issues, accepted);
  }
  return std::ranges::any_of(issues, &RegistryIssue::error) ? job_failed : done;
}

/// A registry to start a survey with: placeholder positions on a grid without overlaps.
void print_yaml(const std::vector<int>& ids, const MarkerCodeOptions& code) {
  constexpr int columns = 10;
  constexpr double spacing_m = 0.5;
  fmt::print("# {} IDs, {} cells apart{}; seed {}. The places are not surveyed.\n", ids.size(),
             code.min_distance, code.all_views ? " in every view" : "", code.seed);
  fmt::print("format: lodestar-markers\nversion: 1\nalignment: {{x_m: 0, y_m: 0, yaw_deg: 0}}\nmarkers:\n");
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::size_t column = i % columns;
    const std::size_t row = i / columns;
    fmt::print("  - {{id: {}, x_m: {}, y_m: {}, z_m: 0, yaw_deg: 0}}\n", ids[i],
               spacing_m * static_cast<double>(column), spacing_m * static_cast<double>(row));
  }
}

ExitCode generate(const GenerateArguments& arguments) {
  std::vector<int> taken;
  if (!arguments.avoid.empty()) {
    for (const RegisteredMarker& marker : load_registry(arguments.avoid).markers) taken.push_back(marker.id);
  }
  MarkerCodeOptions code = arguments.code;
  code.all_views = !arguments.plain;
  const std::vector<int> ids = choose_marker_ids(arguments.count, taken, code);
  if (static_cast<int>(ids.size()) < arguments.count) {
    fmt::print(stderr, "found {} IDs that are {} cells apart{}, wanted {}\n", ids.size(), code.min_distance,
               code.all_views ? " in every view" : "", arguments.count);
    return job_failed;
  }
  if (arguments.format == "yaml") {
    print_yaml(ids, code);
  } else {
    fmt::print("{}\n", fmt::join(ids, "\n"));
  }
  return done;
}

CLI::App* add_generate(CLI::App& markers, GenerateArguments& arguments) {
  CLI::App* command = markers.add_subcommand(
      "generate", "Choose IDs with a minimum Hamming distance; exit 1 when there are not enough");
  command->add_option("--count", arguments.count, "Number of IDs")
      ->required()
      ->type_name("N")
      ->check(CLI::Range(1, marker_id_count));
  command
      ->add_option("--min-hamming", arguments.code.min_distance,
                   "Number of cells in which any two differ. 1: no protection; 2: detects one missed dot or "
                   "glint; 3: corrects one; 4: corrects one and detects two")
      ->check(CLI::Range(1, 12))
      ->capture_default_str();
  command
      ->add_option("--min-dots", arguments.code.min_dots,
                   "Least number of dots per marker, O, X and Y included; fewer dots are more easily "
                   "confused with clutter")
      ->check(CLI::Range(3, 15))
      ->capture_default_str();
  command->add_flag("--plain", arguments.plain,
                    "Compare upright markers only. By default the distance also holds with one of them "
                    "rotated or mirrored, and between a marker and its own rotations");
  command
      ->add_option("--avoid", arguments.avoid, "Registry whose markers the new ones must differ from as well")
      ->type_name("FILE");
  command->add_option("--seed", arguments.code.seed, "Seed of the choice; the same seed gives the same IDs")
      ->capture_default_str();
  add_format_option(*command, arguments.format, {"ids", "yaml"},
                    "ids: one per line; yaml: a registry with placeholder positions, to be surveyed");
  return command;
}

}  // namespace

std::vector<Command> markers_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<MarkersArguments>();
  CLI::App* markers = lodestar.add_subcommand(
      "markers", "Inspect and check marker registries, choose IDs, convert and print markers");
  markers->require_subcommand(1);

  CLI::App* list_command = markers->add_subcommand(
      "list", "List the markers in the map frame, with the registry's alignment applied");
  list_command->add_option("registry", arguments->registry, "Marker registry")->required();
  add_format_option(*list_command, arguments->format, {"text", "csv", "json"}, "text, csv or json");

  CLI::App* check_command = markers->add_subcommand(
      "check",
      "Check for errors, and for markers that may be mistaken for each other; exit 1 when there are errors");
  check_command->add_option("registry", arguments->registry, "Marker registry; by default that of --site");
  CLI::Option* map =
      check_command->add_option("--map", arguments->map, "Occupancy map: markers must lie within it");
  check_command
      ->add_option(
          "--site", arguments->site,
          "Site folder: also report areas and stretches of its usual routes without a marker in view")
      ->excludes(map);
  add_format_option(*check_command, arguments->format, {"text", "json"}, "text or json");

  const auto generated = std::make_shared<GenerateArguments>();
  CLI::App* generate_command = add_generate(*markers, *generated);

  std::vector<Command> commands{{list_command, [arguments] { return list(*arguments); }},
                                {generate_command, [generated] { return generate(*generated); }},
                                {check_command, [arguments] { return check(*arguments); }}};
  for (Command& command : marker_file_commands(*markers)) commands.push_back(std::move(command));
  for (Command& command : marker_site_commands(*markers)) commands.push_back(std::move(command));
  commands.push_back(marker_trust_command(*markers));
  return commands;
}

}  // namespace lodestar
