#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

struct RunPose {
  Stamp stamp;
  Pose2 map_from_base;
  /// Standard deviations; 0 where the file does not have them.
  double sigma_m = 0.0;
  double sigma_rad = 0.0;
};

/// The estimated poses that a run left in its folder, in order of time: steps.csv, or else estimate.tum (TUM:
/// `stamp x y z qx qy qz qw`), which has no deviations. Throws InputError with file and line.
std::vector<RunPose> load_run_poses(const std::filesystem::path& folder);

/// The pose at a time, interpolated between its two neighbours, and the greater of their deviations. Nothing
/// before the first, after the last, or where the neighbours are farther apart than this.
std::optional<RunPose> pose_at(std::span<const RunPose> poses, Stamp stamp, Duration most_apart);

}  // namespace lodestar
