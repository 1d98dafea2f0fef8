#pragma once

#include <array>
#include <cmath>
#include <deque>
#include <optional>
#include <span>

#include "maps/obstacle_field.hpp"
#include "maps/scan.hpp"

namespace lodestar {

struct ScannerMountWatchOptions {
  /// Between no turn and the 2 degrees that must be noticed: at 3 m, they move an end by 10 cm.
  double max_turn_rad = radians(1.5);
  std::size_t scans = 40;  ///< for one estimate, from different places: 4 s at 10 Hz
  std::size_t step = 10;   ///< scans from one estimate to the next: each is of the newest `scans`
  /// Estimates in a row that must say so: heading and walls are off here and there, by a marker that hangs
  /// turned or a cupboard that was moved; a mount is turned wherever the robot drives.
  int agreeing = 3;
  double between_m = 0.05;  ///< scans from the same place say the same
  double between_rad = radians(3.0);
  double most_off_m = 0.15;      ///< ends farther from a wall count as this far: unknown things
  double least_explained = 0.3;  ///< share of hits that end at walls, at the best turn
};

/// Turn of the mount against the map, where the pose is known: the turn of the beams about the scanner at
/// which they end at mapped walls best, over many scans. Notices 2 degrees within 70 scans that are 5 cm or 3
/// degrees apart. A heading of the robot that is off by as much looks alike. A value type.
class ScannerMountWatch {
 public:
  explicit ScannerMountWatch(const ScannerMountWatchOptions& options = {}) : options_(options) {}

  void add(const Scan& scan, std::span<const Pose2> map_from_scanner, const ObstacleField& field);

  /// Of the scanner against its mount in robot.yaml, counter-clockwise; nothing before the first estimate.
  [[nodiscard]] std::optional<double> turned_rad() const { return turned_rad_; }
  [[nodiscard]] bool is_turned() const { return agreeing_ >= options_.agreeing; }

 private:
  static constexpr int steps = 12;  ///< of half a degree, to either side
  static constexpr double step_rad = radians(0.5);

  /// By the turn, summed over scans.
  struct Sums {
    std::array<double, 2 * steps + 1> cost{};       ///< mean squared distance of ends from walls
    std::array<double, 2 * steps + 1> explained{};  ///< share of ends at walls
    std::size_t scans = 0;
  };

  void estimate();

  ScannerMountWatchOptions options_;
  std::deque<Sums> sums_;  ///< of `step` scans each, the newest last
  std::optional<Pose2> last_;
  std::optional<double> turned_rad_;
  int agreeing_ = 0;  ///< of the newest estimates
};

}  // namespace lodestar
