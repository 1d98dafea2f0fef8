#include <algorithm>
#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands/command.hpp"
#include "app/registry_check.hpp"
#include "maps/map_file.hpp"
#include "maps/marker.hpp"
#include "maps/marker_registry.hpp"

namespace lodestar {
namespace {

struct MarkersArguments {
  std::string registry;
  std::string map;
  std::string format = "text";
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

/// Poses are those on the map: the registry's own, through its alignment.
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
  if (arguments.format == "json") fmt::print("{}\n", all.dump(2));
  return done;
}

std::string_view to_string(IssueKind kind) {
  switch (kind) {
    case IssueKind::overlapping:
      return "overlapping";
    case IssueKind::outside_map:
      return "outside-map";
    case IssueKind::similar_ids:
      return "similar-ids";
  }
  return "";
}

void print_json(const HammingReport& hamming, const std::vector<RegistryIssue>& issues, std::size_t markers) {
  nlohmann::ordered_json report{{"markers", markers},
                                {"smallest_hamming_distance", hamming.smallest},
                                {"closest_pairs", hamming.closest_pairs},
                                {"issues", nlohmann::ordered_json::array()}};
  for (const RegistryIssue& issue : issues) {
    report["issues"].push_back({{"kind", to_string(issue.kind)},
                                {"severity", issue.error ? "error" : "warning"},
                                {"ids", issue.ids},
                                {"line", issue.line},
                                {"words", issue.words}});
  }
  fmt::print("{}\n", report.dump(2));
}

void print_text(const std::string& file, const HammingReport& hamming,
                const std::vector<RegistryIssue>& issues, std::size_t markers) {
  for (const RegistryIssue& issue : issues) {
    fmt::print("{}:{}: {}: {}\n", file, issue.line, issue.error ? "error" : "warning", issue.words);
  }
  fmt::print("{} markers; the closest IDs are {} dots apart ({} pairs)\n", markers, hamming.smallest,
             hamming.closest_pairs.size());
  constexpr std::size_t enough = 10;
  for (std::size_t i = 0; i < std::min(enough, hamming.closest_pairs.size()); ++i) {
    fmt::print("  {} and {}\n", hamming.closest_pairs[i].first, hamming.closest_pairs[i].second);
  }
}

ExitCode check(const MarkersArguments& arguments) {
  const MarkerRegistry registry = load_registry(arguments.registry);
  std::optional<OccupancyMap> map;
  if (!arguments.map.empty()) map = load_map(arguments.map).map;
  const HammingReport hamming = hamming_report(registry);
  const std::vector<RegistryIssue> issues = check_registry(registry, map);
  if (arguments.format == "json") {
    print_json(hamming, issues, registry.markers.size());
  } else {
    print_text(arguments.registry, hamming, issues, registry.markers.size());
  }
  return std::ranges::any_of(issues, &RegistryIssue::error) ? job_failed : done;
}

}  // namespace

std::vector<Command> markers_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<MarkersArguments>();
  CLI::App* markers = lodestar.add_subcommand("markers", "Look at a marker registry");
  markers->require_subcommand(1);

  CLI::App* list_command = markers->add_subcommand("list", "The markers as they lie on the map");
  list_command->add_option("registry", arguments->registry, "Marker registry")->required();
  list_command->add_option("--format", arguments->format, "text, csv or json")
      ->check(CLI::IsMember({"text", "csv", "json"}))
      ->capture_default_str();

  CLI::App* check_command =
      markers->add_subcommand("check", "Look for mistakes; exit 1 when there are errors");
  check_command->add_option("registry", arguments->registry, "Marker registry")->required();
  check_command->add_option("--map", arguments->map, "Occupancy map: markers must hang above it");
  check_command->add_option("--format", arguments->format, "text or json")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();

  return {{list_command, [arguments] { return list(*arguments); }},
          {check_command, [arguments] { return check(*arguments); }}};
}

}  // namespace lodestar
