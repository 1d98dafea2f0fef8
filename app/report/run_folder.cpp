#include "app/report/run_folder.hpp"

#include <cmath>
#include <fmt/core.h>

#include "app/report/figure.hpp"
#include "app/report/report.hpp"
#include "app/report/run_statistics.hpp"
#include "drivers/candump.hpp"
#include "maps/atomic_file.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

/// TUM: stamp, position, quaternion with w last, single spaces.
void append_tum(std::string& text, Stamp stamp, const Pose2& pose) {
  text += fmt::format("{:.9f} {:.6f} {:.6f} 0.000000 0.000000000 0.000000000 {:.9f} {:.9f}\n", seconds(stamp),
                      pose.position_m.x(), pose.position_m.y(), std::sin(0.5 * pose.yaw_rad),
                      std::cos(0.5 * pose.yaw_rad));
}

/// Steps between two wheel readings repeat an estimate; a trajectory's stamps must ascend.
std::string estimate_tum(const RunRecord& record) {
  std::string text;
  std::optional<Stamp> last;
  for (const StepRecord& step : record.steps) {
    if (last && step.estimate.stamp <= *last) continue;
    append_tum(text, step.estimate.stamp, step.estimate.map_from_base);
    last = step.estimate.stamp;
  }
  return text;
}

std::string truth_tum(const RunRecord& record) {
  std::string text;
  for (const TruePose& pose : record.truth) append_tum(text, pose.stamp, pose.map_from_base);
  return text;
}

std::string can_log(const RunRecord& record) {
  std::string text;
  for (const StampedCanFrame& frame : record.can_frames) text += candump_line(frame) + "\n";
  return text;
}

}  // namespace

void write_run_folder(const std::filesystem::path& folder, const RunRecord& record, const OccupancyMap& map,
                      const MarkerRegistry& registry) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError(folder, 0, "a folder that could not be made (" + error.message() + ")", "one that can");
  const std::string picture = png_bytes(draw_experiment(record, map, registry));
  write_file_atomically(folder / "summary.json", summary_of(record).dump(2) + "\n");
  write_file_atomically(folder / "map.png", picture);
  write_file_atomically(folder / "estimate.tum", estimate_tum(record));
  write_file_atomically(folder / "truth.tum", truth_tum(record));
  write_file_atomically(folder / "can.log", can_log(record));
  write_file_atomically(folder / "report.html", report_html(record, picture));
}

bool leave_run_folder(const std::filesystem::path& folder, const RunRecord& record, const OccupancyMap& map,
                      const MarkerRegistry& registry) {
  try {
    write_run_folder(folder, record, map, registry);
    return true;
  } catch (const InputError& error) {
    fmt::print(stderr, "lodestar: warning: the run is not recorded: {}\n", error.what());
    return false;
  }
}

}  // namespace lodestar
