#include "app/placement/placed_scans.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace lodestar {

std::string in_words(const ScanCounts& counts) {
  return fmt::format("{} of {} scans used; {} without a sure pose, {} while the robot stood", counts.used,
                     counts.scans, counts.without_pose, counts.standing);
}

void PlacedScans::forget_before(Stamp stamp) {
  const auto first = std::ranges::lower_bound(poses_, stamp, {}, &RunPose::stamp);
  poses_.erase(poses_.begin(), first);
}

bool PlacedScans::add(Scan scan) {
  ++counts_.scans;
  locate(scan);
  if (scan.beams.empty()) {
    ++counts_.without_pose;
    return true;
  }
  if (is_standing(scan.beams.front().stamp)) {
    ++counts_.standing;
    return true;
  }
  if (!builder_.add(scan, map_from_scanner_)) return false;
  ++counts_.used;
  return true;
}

/// Keeps the beams with a pose that is sure enough, and notes the scanner's pose at each.
void PlacedScans::locate(Scan& scan) {
  map_from_scanner_.clear();
  std::erase_if(scan.beams, [this](const Beam& beam) {
    const std::optional<RunPose> pose = pose_at(poses_, beam.stamp, options_.most_apart);
    if (!pose || pose->sigma_m > options_.most_sigma_m || pose->sigma_rad > options_.most_sigma_rad)
      return true;
    map_from_scanner_.push_back(pose->map_from_base * base_from_scanner_);
    return false;
  });
}

bool PlacedScans::is_standing(Stamp stamp) {
  const Pose2& now = map_from_scanner_.front();
  const bool stands =
      last_used_ && (now.position_m - last_used_->map_from_base.position_m).norm() < options_.standing_m &&
      std::abs(wrap_angle(now.yaw_rad - last_used_->map_from_base.yaw_rad)) < options_.standing_rad &&
      stamp - last_used_->stamp < options_.standing_period;
  if (!stands) last_used_ = RunPose{.stamp = stamp, .map_from_base = now};
  return stands;
}

}  // namespace lodestar
