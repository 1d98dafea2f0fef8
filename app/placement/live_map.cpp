#include "app/placement/live_map.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <utility>

#include "maps/input_error.hpp"
#include "maps/map_file.hpp"
#include "maps/path_kind.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

/// So long a scan waits for a pose; the estimate is of the newest wheel reading.
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
  std::ranges::move(heard.scans, std::back_inserter(waiting_));
  if (!heard.pose) return;
  const Stamp now = heard.pose->stamp;
  placed_.add(*heard.pose);
  place(now);
  if (!written_) written_ = now;
  if (now - *written_ < options_.period) return;
  written_ = now;
  write();
}

void LiveMap::place(Stamp newest_pose) {
  while (!waiting_.empty()) {
    Scan& scan = waiting_.front();
    if (!scan.beams.empty() && newest_pose < scan.beams.back().stamp) break;
    const bool has_room = placed_.add(std::move(scan));
    waiting_.pop_front();
    if (!has_room)
      throw InputError(file_, 0, "a scan that is far off", "scans in one room: the map grows too large");
  }
  placed_.forget_before(newest_pose - longest_wait);
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
    if (placed_.counts().used == 0)
      return file_.string() + ": no scan that has a pose known to 2 cm and 0.5 degrees";
    write();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace lodestar
