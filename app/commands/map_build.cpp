#include <filesystem>
#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands/commands.hpp"
#include "app/common/json_text.hpp"
#include "app/common/progress.hpp"
#include "app/placement/map_from_runs.hpp"
#include "maps/map_file.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

struct BuildArguments {
  std::vector<std::string> runs;
  std::string output;
  double resolution_m = OccupancyBuilderOptions{}.resolution_m;
  bool json = false;
  bool quiet = false;
};

nlohmann::ordered_json as_json(const MapFromRuns& built) {
  nlohmann::ordered_json runs = nlohmann::ordered_json::array();
  for (const RunScans& run : built.runs) {
    runs.push_back({{"run", run.run.string()},
                    {"started", run.started},
                    {"scans", run.counts.scans},
                    {"used", run.counts.used},
                    {"without_pose", run.counts.without_pose},
                    {"standing", run.counts.standing},
                    {"bytes_cut_off", run.bytes_cut_off}});
  }
  return {{"columns", built.map.columns},
          {"rows", built.map.rows},
          {"resolution_m", built.map.resolution_m},
          {"runs", runs}};
}

void say(const MapFromRuns& built) {
  for (const RunScans& run : built.runs) {
    fmt::print(stderr, "{}: {}\n", run.run.string(), in_words(run.counts));
    if (run.bytes_cut_off > 0)
      fmt::print(stderr, "lodestar: warning: {}: the last scan is cut off after {} bytes and left out\n",
                 (run.run / "scans.bin").string(), run.bytes_cut_off);
  }
}

ExitCode build(const BuildArguments& arguments) {
  MapFromRunsOptions options;
  options.builder.resolution_m = arguments.resolution_m;
  const std::vector<fs::path> runs(arguments.runs.begin(), arguments.runs.end());
  Progress progress("map", arguments.quiet);
  options.progress = [&progress](double share) { progress.show(share); };
  const MapFromRuns built = map_from_runs(runs, options);
  say(built);
  save_map(built.map, arguments.output, provenance_comment(built));
  if (arguments.json) fmt::print("{}", json_document(as_json(built)));
  return done;
}

}  // namespace

Command map_build_command(CLI::App& map) {
  const auto arguments = std::make_shared<BuildArguments>();
  CLI::App* command = map.add_subcommand("build", "Build a map from the scans and poses of runs");
  command->add_option("runs", arguments->runs, "Run folders with scans.bin and steps.csv or estimate.tum")
      ->required();
  command->add_option("-o,--output", arguments->output, "map_server YAML file to write")->required();
  command->add_option("--resolution", arguments->resolution_m, "Side of a cell in metres")
      ->check(CLI::Range(0.005, 1.0))
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "What was used, as JSON");
  command->add_flag("--quiet", arguments->quiet, "No progress bar");
  return {command, [arguments] { return build(*arguments); }};
}

}  // namespace lodestar
