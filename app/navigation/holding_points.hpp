#pragma once

#include <optional>
#include <vector>

#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

struct HoldingPointsOptions {
  Duration after = std::chrono::seconds(2);  ///< twenty scans at 10 Hz: the noise of one does not count
  Duration kept = std::chrono::seconds(30);  ///< as ObstacleMemoryOptions::remembered_standing
  double apart_m = 0.03;                     ///< nearer than that, hits are of the same point
};

/// Where the protective field holds the robot by what does not move. A path planned on the map leads past
/// there, and would for ever: a post's frame, a door that is not quite open, a map that is a few centimetres
/// off, all of which the map explains within the tolerance of a scan. Frame of all points: the odometry's.
class HoldingPoints {
 public:
  explicit HoldingPoints(const HoldingPointsOptions& options = {}) : options_(options) {}

  /// Once a control step: the hit by which the robot is held, if by one that does not move.
  void update(Stamp now, const std::optional<Vec2>& held_by_m);

  /// The robot goes on.
  void release() { held_ = Duration::zero(); }

  [[nodiscard]] std::vector<Vec2> points_m(Stamp now) const;

 private:
  struct Point {
    Vec2 position_m;
    Stamp last;
  };

  HoldingPointsOptions options_;
  Duration held_{};  ///< since it went on last
  std::optional<Stamp> last_;
  std::vector<Point> points_;
};

}  // namespace lodestar
