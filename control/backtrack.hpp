#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "control/safety_stop.hpp"
#include "maps/geometry.hpp"

namespace lodestar {

struct BacktrackOptions {
  double before_last_m = 0.8;   ///< the robot backtracks to this far before the last marker sighting
  int most_to_a_goal = 3;       ///< backtracks per goal; then the robot stays where it is
  double markers_view_m = 1.5;  ///< farther away, the last marker is out of view
  /// Limits while backtracking: wider, as the robot has just driven that way and knows it to be free.
  SafetyStopOptions limits{.max_time_unseen = std::chrono::seconds(60),
                           .max_position_sigma_m = 0.20,
                           .max_heading_sigma_rad = radians(12.0)};
};

/// Recovery behaviour of a robot that has driven too far without a marker: where it backtracks to. There a
/// marker restores its pose; the planner learns where no marker is, for another path; and the filter learns
/// the wheel scales on the way, so that the robot gets farther if there is no other path. A value type.
class Backtrack {
 public:
  explicit Backtrack(const BacktrackOptions& options = {}) : options_(options) {}

  /// Records a position where a marker agreed with the estimate.
  void saw_marker_at(const Vec2& position_in_map);

  /// Records a position where no marker did.
  void saw_no_marker_at(const Vec2& position_in_map);

  /// Is another backtrack allowed? Only after a marker was seen since the last one, and within the limit per
  /// goal.
  [[nodiscard]] bool possible() const {
    return !seen_at_m_.empty() && has_seen_ && made_ < options_.most_to_a_goal;
  }

  /// Target of the next backtrack; nothing when none is allowed.
  [[nodiscard]] std::optional<Vec2> place_m() const {
    return possible() ? std::optional(seen_at_m_.front()) : std::nullopt;
  }

  /// Counts a backtrack and returns its target. Nothing when none is allowed.
  std::optional<Vec2> begin();

  /// The robot has reached the backtrack's target.
  void reached_place() { found_no_marker_ = !has_seen_; }

  /// The robot is back where it saw markers before, and has seen none since the backtrack began. Then the
  /// camera is blind or the pose is wrong, and the robot must not go on.
  [[nodiscard]] bool found_no_marker() const { return found_no_marker_; }

  /// Is this position far from the backtrack's target? Then a marker seen here is another one, and the robot
  /// ends the backtrack.
  [[nodiscard]] bool is_far_from_its_end(const Vec2& position_in_map) const {
    return (position_in_map - towards_m_).norm() > options_.markers_view_m;
  }

  /// Positions without a marker in view before each backtrack so far, in steps of 0.1 m.
  [[nodiscard]] std::span<const Vec2> blind_places_m() const { return blind_places_m_; }

  /// Restarts the count for another goal.
  void new_goal() { made_ = 0; }

 private:
  BacktrackOptions options_;
  std::deque<Vec2> seen_at_m_;  ///< last positions with a marker in view, a step apart
  Vec2 towards_m_ = Vec2::Zero();
  std::vector<Vec2> unseen_at_m_;     ///< positions since the last marker, a step apart
  std::vector<Vec2> blind_places_m_;  ///< those that ended in a backtrack
  int made_ = 0;
  bool has_seen_ = false;  ///< a marker, since the last backtrack began
  bool found_no_marker_ = false;
};

}  // namespace lodestar
