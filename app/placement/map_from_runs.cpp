#include "app/placement/map_from_runs.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <utility>
#include <yaml-cpp/yaml.h>

#include "app/frames/run_poses.hpp"
#include "app/recording/scan_file.hpp"
#include "maps/input_error.hpp"
#include "maps/path_kind.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

/// run.yaml is there for people and later programs; a map can do without it.
std::string start_of(const fs::path& run) {
  if (!is_file(run / "run.yaml")) return {};
  try {
    const YAML::Node started = YAML::LoadFile((run / "run.yaml").string())["started"];
    std::string text = started && started.IsScalar() ? started.Scalar() : std::string();
    std::ranges::replace_if(text, [](unsigned char letter) { return letter < ' '; }, ' ');
    return text;
  } catch (const YAML::Exception&) {
    return {};
  }
}

RunScans read(const fs::path& run, const PlacedScansOptions& options, OccupancyBuilder& builder) {
  const fs::path file = run / "scans.bin";
  if (!is_folder(run)) throw InputError(run, 0, "no such folder", "that of a run");
  if (!is_file(file))
    throw InputError(file, 0, "no such file", "the scans of a run of a robot with a scanner");
  const std::vector<RunPose> poses = load_run_poses(run);
  if (poses.empty())
    throw InputError(run, 0, "a run without a pose", "one in which the robot knew where it was");
  ScanFileReader reader(file);
  PlacedScans placed(options, reader.mount().base_from_scanner, builder);
  for (const RunPose& pose : poses) placed.add(pose);
  while (std::optional<LoggedScan> logged = reader.next()) {
    if (placed.add(std::move(logged->scan))) continue;
    const Vec2& at_m = placed.map_from_scanner().position_m;
    throw InputError(file, 0, fmt::format("a scan at ({:.1f}, {:.1f})", at_m.x(), at_m.y()),
                     "runs in one room, or a coarser --resolution: the map grows too large");
  }
  if (placed.counts().scans == 0) throw InputError(file, 0, "no scan", "the scans of a run");
  return {.run = run,
          .started = start_of(run),
          .counts = placed.counts(),
          .bytes_cut_off = reader.bytes_cut_off()};
}

}  // namespace

MapFromRuns map_from_runs(std::span<const fs::path> runs, const MapFromRunsOptions& options) {
  OccupancyBuilder builder(options.builder);
  MapFromRuns built;
  for (const fs::path& run : runs) {
    built.runs.push_back(read(run, options.scans, builder));
    if (options.progress)
      options.progress(static_cast<double>(built.runs.size()) / static_cast<double>(runs.size()));
  }
  built.map = builder.map();
  if (built.map.cells.empty())
    throw InputError(runs.empty() ? fs::path("map build") : runs.front(), 0, nothing_placed,
                     "a run in which the robot saw markers");
  return built;
}

std::string provenance_comment(const MapFromRuns& built) {
  std::string text = fmt::format("# built by lodestar map build at {} m, from:\n", built.map.resolution_m);
  for (const RunScans& run : built.runs) {
    std::string name = fs::absolute(run.run).lexically_normal().string();
    std::ranges::replace_if(name, [](unsigned char letter) { return letter < ' '; }, '?');
    text += fmt::format("#   {}: {}{} of {} scans\n", name,
                        run.started.empty() ? "" : "started " + run.started + ", ", run.counts.used,
                        run.counts.scans);
  }
  return text;
}

}  // namespace lodestar
