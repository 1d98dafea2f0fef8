#include <string>

#include "app/frames/drive_log.hpp"
#include "app/frames/run_poses.hpp"
#include "app/navigation/learned_state.hpp"
#include "app/placement/accepted_issues.hpp"
#include "app/placement/hanging.hpp"
#include "app/simulate/scenario_file.hpp"
#include "maps/input_error.hpp"
#include "maps/paper_camera.hpp"

#include "tests/fuzz/scratch_file.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

void check_hanging(const fs::path& folder) {
  const std::map<int, HungMarker> read = load_hanging(folder);
  save_hanging(read, folder);
  const std::map<int, HungMarker> again = load_hanging(folder);
  if (again.size() != read.size()) __builtin_trap();
  for (const auto& [id, marker] : read)
    if (again.at(id).state != marker.state || again.at(id).by != marker.by) __builtin_trap();
}

void check_accepted(const fs::path& folder) {
  const std::vector<AcceptedIssue> read = load_accepted(folder);
  save_accepted(read, folder);
  const std::vector<AcceptedIssue> again = load_accepted(folder);
  if (again.size() != read.size()) __builtin_trap();
  for (std::size_t i = 0; i < read.size(); ++i)
    if (again[i].ids != read[i].ids || again[i].reason != read[i].reason) __builtin_trap();
}

/// Whatever the file holds, a robot can start; and what trust_again() takes is then gone.
void check_state(const fs::path& file) {
  (void)load_state(file, {});
  const std::vector<int> all{0, 1, 2, 3};
  (void)trust_again(file, all);
  if (!trust_again(file, all).empty()) __builtin_trap();
}

void check_poses(const fs::path& folder) {
  const std::vector<RunPose> poses = load_run_poses(folder);
  for (std::size_t i = 1; i < poses.size(); ++i)
    if (poses[i].stamp <= poses[i - 1].stamp) __builtin_trap();
  for (const RunPose& pose : poses)
    if (!pose.map_from_base.position_m.allFinite() || !std::isfinite(pose.map_from_base.yaw_rad))
      __builtin_trap();
}

void check_wheels(const fs::path& file) {
  if (load_wheels(file).empty()) __builtin_trap();
}

void check_scenario(const fs::path& file) {
  static const Site lab = [] {
    Site site;
    site.cameras.emplace("wide", paper_camera());
    site.default_camera = "wide";
    return site;
  }();
  const Scenario scenario = load_scenario(file, lab);
  if (scenario.site.goals.size() != 1 || !(scenario.time_limit_s > 0.0)) __builtin_trap();
  for (const MovingDisc& disc : scenario.discs)
    if (disc.trajectory.keys.empty()) __builtin_trap();
}

void check(char kind, const std::uint8_t* data, std::size_t size) {
  const auto put = [&](const char* name) { return scratch_file(name, data, size); };
  if (kind == 'h') return check_hanging(put(hanging_file_name).parent_path());
  if (kind == 'a') return check_accepted(put(accepted_file_name).parent_path());
  if (kind == 's') return check_state(put("state.yaml"));
  if (kind == 'w') return check_wheels(put("wheels.csv"));
  if (kind == 'c') return check_scenario(put("scenario.yaml"));
  if (kind != 'p' && kind != 't') return;
  const fs::path file = put(kind == 'p' ? "steps.csv" : "estimate.tum");
  if (kind == 't') fs::remove(file.parent_path() / "steps.csv");
  check_poses(file.parent_path());
}

}  // namespace
}  // namespace lodestar

// The first byte chooses a file that the folder of a site or of a run may hold beside its main one. It is
// refused with an InputError, or read whole; what is written again is read again to the same.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  try {
    lodestar::check(static_cast<char>(data[0]), data + 1, size - 1);
  } catch (const lodestar::InputError&) {
  }
  return 0;
}
