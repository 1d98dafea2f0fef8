#include "app/placement/map_from_runs.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
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

/// Adds one run's scans to the map.
class RunReader {
 public:
  RunReader(const fs::path& run, const MapFromRunsOptions& options, OccupancyBuilder& builder)
      : options_(options), builder_(builder), file_(run / "scans.bin") {
    if (!is_folder(run)) throw InputError(run, 0, "no such folder", "that of a run");
    if (!is_file(file_))
      throw InputError(file_, 0, "no such file", "the scans of a run of a robot with a scanner");
    poses_ = load_run_poses(run);
    if (poses_.empty())
      throw InputError(run, 0, "a run without a pose", "one in which the robot knew where it was");
    result_.run = run;
    result_.started = start_of(run);
  }

  RunScans read() {
    ScanFileReader reader(file_);
    base_from_scanner_ = reader.mount().base_from_scanner;
    while (const std::optional<LoggedScan> logged = reader.next()) add(logged->scan);
    result_.bytes_cut_off = reader.bytes_cut_off();
    if (result_.scans == 0) throw InputError(file_, 0, "no scan", "the scans of a run");
    return result_;
  }

 private:
  void add(Scan scan) {
    ++result_.scans;
    locate(scan);
    if (scan.beams.empty()) {
      ++result_.without_pose;
      return;
    }
    if (is_standing(scan.beams.front().stamp)) {
      ++result_.standing;
      return;
    }
    if (!builder_.add(scan, map_from_scanner_))
      throw InputError(file_, 0,
                       fmt::format("a scan at ({:.1f}, {:.1f})", map_from_scanner_.front().position_m.x(),
                                   map_from_scanner_.front().position_m.y()),
                       "runs in one room, or a coarser --resolution: the map grows too large");
    ++result_.used;
  }

  /// Keeps the beams with a pose that is sure enough, and notes the scanner's pose at each.
  void locate(Scan& scan) {
    map_from_scanner_.clear();
    std::erase_if(scan.beams, [this](const Beam& beam) {
      const std::optional<RunPose> pose = pose_at(poses_, beam.stamp, options_.most_apart);
      if (!pose || pose->sigma_m > options_.most_sigma_m || pose->sigma_rad > options_.most_sigma_rad)
        return true;
      map_from_scanner_.push_back(pose->map_from_base * base_from_scanner_);
      return false;
    });
  }

  bool is_standing(Stamp stamp) {
    const Pose2& now = map_from_scanner_.front();
    const bool stands =
        last_used_ && (now.position_m - last_used_->map_from_base.position_m).norm() < options_.standing_m &&
        std::abs(wrap_angle(now.yaw_rad - last_used_->map_from_base.yaw_rad)) < options_.standing_rad &&
        stamp - last_used_->stamp < options_.standing_period;
    if (!stands) last_used_ = RunPose{.stamp = stamp, .map_from_base = now};
    return stands;
  }

  const MapFromRunsOptions& options_;
  OccupancyBuilder& builder_;
  fs::path file_;
  std::vector<RunPose> poses_;
  Pose2 base_from_scanner_;
  std::vector<Pose2> map_from_scanner_;  ///< one for each beam
  std::optional<RunPose> last_used_;     ///< the scanner's
  RunScans result_;
};

}  // namespace

MapFromRuns map_from_runs(std::span<const fs::path> runs, const MapFromRunsOptions& options) {
  OccupancyBuilder builder(options.builder);
  MapFromRuns built;
  for (const fs::path& run : runs) {
    built.runs.push_back(RunReader(run, options, builder).read());
    if (options.progress)
      options.progress(static_cast<double>(built.runs.size()) / static_cast<double>(runs.size()));
  }
  built.map = builder.map();
  if (built.map.cells.empty())
    throw InputError(runs.empty() ? fs::path("map build") : runs.front(), 0,
                     "no scan that has a pose known to 2 cm and 0.5 degrees, or no echo in any",
                     "a run in which the robot saw markers");
  return built;
}

std::string provenance_comment(const MapFromRuns& built) {
  std::string text = fmt::format("# built by lodestar map build at {} m, from:\n", built.map.resolution_m);
  for (const RunScans& run : built.runs) {
    std::string name = fs::absolute(run.run).lexically_normal().string();
    std::ranges::replace_if(name, [](unsigned char letter) { return letter < ' '; }, '?');
    text += fmt::format("#   {}: {}{} of {} scans\n", name,
                        run.started.empty() ? "" : "started " + run.started + ", ", run.used, run.scans);
  }
  return text;
}

}  // namespace lodestar
