#pragma once

#include <optional>
#include <vector>

#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

struct HoldingPointsOptions {
  Duration after = std::chrono::seconds(2);  ///< twenty scans at 10 Hz: the noise of one does not count
  /// Whoever only pauses is gone sooner: as LingeringPeopleOptions::lingers_from.
  Duration after_if_it_may_go = std::chrono::seconds(25);
  Duration kept = std::chrono::seconds(30);  ///< as ObstacleMemoryOptions::remembered_standing
  double apart_m = 0.03;                     ///< nearer than that, hits are of the same point
  /// No farther than this from where it was held first, nor turned farther, the robot is still held: the
  /// noise of the range lets it creep by millimetres.
  double creeps_m = 0.05;
  double creeps_rad = 0.1;
  /// From one step in which it is held to the next: between two scans it may want so little that nothing
  /// speaks against it.
  Duration longest_between = std::chrono::milliseconds(300);
};

/// A hit by which the robot is held.
struct HoldingPoint {
  Vec2 position_m = Vec2::Zero();
  bool may_go = false;  ///< it has come there by itself
};

/// Where the protective field holds the robot by what does not move. A path planned on the map leads past
/// there, and would for ever: a post's frame, a door that is not quite open, a map that is a few centimetres
/// off, all of which the map explains within the tolerance of a scan; or someone who has come to stay. Frame
/// of everything here: the odometry's.
class HoldingPoints {
 public:
  explicit HoldingPoints(const HoldingPointsOptions& options = {}) : options_(options) {}

  /// Once a control step, before what holds the robot there is added.
  void stand_at(const Pose2& odom_from_base);

  /// It is held, by this.
  void add(const HoldingPoint& point, Stamp now);

  [[nodiscard]] std::vector<HoldingPoint> points(Stamp now) const;

 private:
  struct Known {
    HoldingPoint point;
    Stamp last;
  };
  struct Held {
    Duration lasts{};
    std::optional<Stamp> last;
  };

  [[nodiscard]] bool has_gone_on(const Pose2& odom_from_base) const;

  HoldingPointsOptions options_;
  std::optional<Pose2> place_;  ///< odom_from_base where it was held first
  Held by_what_stays_;          ///< there
  Held by_what_may_go_;         ///< there
  std::vector<Known> known_;
};

}  // namespace lodestar
