#include "app/placement/live_map.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "maps/input_error.hpp"
#include "maps/map_file.hpp"
#include "maps/path_kind.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

/// So long a scan waits for the pose of its time, which is that of a wheel reading, and so long poses are
/// kept.
constexpr Duration longest_wait = std::chrono::seconds(1);

fs::path checked(fs::path file) {
  check_map_name(file);
  const fs::path folder = fs::absolute(file).parent_path();
  if (!is_folder(folder)) throw InputError(folder, 0, "no such folder", "one for the map");
  return file;
}

}  // namespace

LiveMap::LiveMap(fs::path file, const ScannerMount& mount, const LiveMapOptions& options)
    : file_(checked(std::move(file))),
      options_(options),
      builder_(options.builder),
      placed_(options.scans, mount.base_from_scanner, builder_),
      writer_({.most_waiting = options.most_waiting, .can_wait = options.can_wait, .tell = options.tell},
              [this](Heard& heard) { add(heard); }) {}

void LiveMap::take(const std::vector<Scan>& scans, const std::optional<PoseEstimate>& estimate) {
  Heard heard{.scans = scans, .pose = std::nullopt};
  if (estimate)
    heard.pose = RunPose{.stamp = estimate->stamp,
                         .map_from_base = estimate->map_from_base,
                         .sigma_m = larger_sigma(estimate->covariance.topLeftCorner<2, 2>()),
                         .sigma_rad = std::sqrt(std::max(estimate->covariance(2, 2), 0.0))};
  if (heard.pose || !heard.scans.empty()) writer_.put(std::move(heard));
}

void LiveMap::add(Heard& heard) {
  for (Scan& scan : heard.scans)
    if (!scan.beams.empty()) waiting_.push_back(std::move(scan));
  if (heard.pose) {
    placed_.add(*heard.pose);
    newest_pose_ = heard.pose->stamp;
  }
  place();
  if (!heard.pose) return;
  const Stamp now = heard.pose->stamp;
  placed_.forget_before(now - longest_wait);
  if (!written_) written_ = now;
  if (now - *written_ < options_.period) return;
  written_ = now;
  write();
}

/// Those whose pose is known, and those for which it comes no more, as of a robot that is lost.
void LiveMap::place() {
  const auto end_of = [](const Scan& scan) { return scan.beams.back().stamp; };
  while (!waiting_.empty()) {
    const Stamp end = end_of(waiting_.front());
    if (end > newest_pose_ && end > end_of(waiting_.back()) - longest_wait) return;
    const bool has_room = placed_.add(std::move(waiting_.front()));
    waiting_.pop_front();
    if (!has_room)
      throw InputError(file_, 0, "a scan that is far off", "scans in one room: the map grows too large");
  }
}

void LiveMap::write() const {
  const OccupancyMap map = builder_.map();
  if (map.cells.empty()) return;
  const ScanCounts& counts = placed_.counts();
  save_map(map, file_.string(),
           fmt::format("# built by {} while the robot drove, at {} m, from {} of {} scans\n",
                       options_.made_by, map.resolution_m, counts.used, counts.scans));
}

std::string LiveMap::finish() {
  std::string loss = writer_.finish().loss(file_.string());
  if (!loss.empty()) return loss;
  try {
    if (placed_.counts().used == 0) return fmt::format("{}: {}", file_.string(), nothing_placed);
    write();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace lodestar
