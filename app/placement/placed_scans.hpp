#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/frames/run_poses.hpp"
#include "maps/occupancy_builder.hpp"
#include "maps/scan.hpp"

namespace lodestar {

struct PlacedScansOptions {
  /// Poses less sure than this are left out: an error that stays within a cell of 5 cm, at 3 m.
  double most_sigma_m = 0.02;
  double most_sigma_rad = radians(0.5);
  /// Between two poses of a run, which come 50 times a second.
  Duration most_apart = std::chrono::milliseconds(100);
  /// Scans of a robot that moved less than this share their error, and what stands before it: they count once
  /// in this time.
  double standing_m = 0.02;
  double standing_rad = radians(1.0);
  Duration standing_period = std::chrono::seconds(1);
};

/// What became of the scans of one drive.
struct ScanCounts {
  std::size_t scans = 0;
  std::size_t used = 0;
  std::size_t without_pose = 0;  ///< before the first fix, or the pose was not sure enough
  std::size_t standing = 0;      ///< like the ones before
};

/// As both maps say it: "7 of 9 scans used; 1 without a sure pose, 1 while the robot stood".
std::string in_words(const ScanCounts& counts);

inline constexpr const char* nothing_placed =
    "no scan that has a pose known to 2 cm and 0.5 degrees, or no echo in any";

/// The scans of one drive, placed by the poses of the robot on a map that is being built.
class PlacedScans {
 public:
  PlacedScans(const PlacedScansOptions& options, const Pose2& base_from_scanner, OccupancyBuilder& builder)
      : options_(options), base_from_scanner_(base_from_scanner), builder_(builder) {}

  /// In order of time, and before the scans of that time.
  void add(const RunPose& pose) { poses_.push_back(pose); }
  /// Poses before this are of no more use.
  void forget_before(Stamp stamp);

  /// False when the map would grow too large, as by a pose that is far off: map_from_scanner() is there.
  [[nodiscard]] bool add(Scan scan);

  [[nodiscard]] const ScanCounts& counts() const { return counts_; }
  /// At the first beam of the newest scan that had a pose.
  [[nodiscard]] const Pose2& map_from_scanner() const { return map_from_scanner_.front(); }

 private:
  void locate(Scan& scan);
  bool is_standing(Stamp stamp);

  PlacedScansOptions options_;
  Pose2 base_from_scanner_;
  OccupancyBuilder& builder_;
  std::vector<RunPose> poses_;
  std::vector<Pose2> map_from_scanner_;  ///< one for each beam
  std::optional<RunPose> last_used_;     ///< the scanner's
  ScanCounts counts_;
};

}  // namespace lodestar
