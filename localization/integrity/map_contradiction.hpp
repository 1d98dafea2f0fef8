#pragma once

#include <deque>
#include <span>

#include "maps/occupancy_map.hpp"
#include "maps/scan.hpp"

namespace lodestar {

struct MapContradictionOptions {
  /// A beam contradicts when it goes so far on behind a mapped wall, plus three deviations of its end: more
  /// than a cell of 5 cm, by which a wall of the map may be off. Of 0.05, 0.07, 0.09 and 0.12 m the greatest
  /// that still notices 10 cm in nine places of ten; a map that is less exact needs more.
  double slack_m = 0.07;
  double sigmas = 3.0;
  /// Through the wall itself: less is a corner that it grazes.
  double least_chord_m = 0.02;
  /// A door that was opened or a cupboard that is gone lengthens the beams of one or two sectors.
  int least_sectors = 3;
  /// Sectors are runs of contradicting beams, at least this far apart and with at least so many beams each.
  double between_sectors_rad = radians(2.5);
  int least_beams = 2;
  /// Persistent: as many of the last `scans` as `least_scans` contradict. At 10 Hz, half a second.
  std::size_t scans = 5;
  std::size_t least_scans = 4;
};

/// How well the pose is believed to be known, and what noise a range has.
struct PoseSigmas {
  double position_m = 0.005;
  double heading_rad = radians(0.1);
  double range_m = 0.01;
};

/// A second opinion on the pose by the map: beams that pass through mapped walls contradict it. Unknown
/// things only shorten beams, so that they never do. It raises an alarm and is never a fix. From one place of
/// the lab it notices 10 cm in 90, 88 and 76 % of places with 0, 30 and 60 % of the beams hidden by unknown
/// things, and 3 degrees in 97, 94 and 89 %: a robot that stands may stay unnoticed until it drives on. A
/// value type.
class MapContradiction {
 public:
  explicit MapContradiction(const MapContradictionOptions& options = {}) : options_(options) {}

  /// Judges a scan; `map_from_scanner` has one pose for each of its beams, by the estimate.
  void update(const Scan& scan, std::span<const Pose2> map_from_scanner, const OccupancyMap& map,
              const PoseSigmas& sigmas);

  /// The pose is not where the robot is, or the map is not of this place.
  [[nodiscard]] bool alarm() const;

  /// Separate sectors of the newest scan whose beams pass through mapped walls.
  [[nodiscard]] int sectors() const { return sectors_; }

  /// After the robot has been placed anew.
  void reset() {
    contradicts_.clear();
    sectors_ = 0;
  }

 private:
  MapContradictionOptions options_;
  int sectors_ = 0;
  std::deque<bool> contradicts_;  ///< the last scans
};

/// How far a beam goes through occupied cells until `slack_m` before its end, in metres.
double wall_passed_m(const OccupancyMap& map, const Vec2& from_in_map, double heading_rad, double range_m,
                     double slack_m);

}  // namespace lodestar
