#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "control/safety_stop.hpp"
#include "maps/geometry.hpp"

namespace lodestar {

struct BacktrackOptions {
  double before_last_m = 0.8;   ///< so far before the last place with a marker in view the robot goes back
  int most_to_a_goal = 3;       ///< then it stays where it is
  double markers_view_m = 1.5;  ///< from farther away the last marker is not seen
  /// How lost it may be on its way back, which it knows to be free because it has just come that way.
  SafetyStopOptions limits{.max_time_unseen = std::chrono::seconds(60),
                           .max_position_sigma_m = 0.20,
                           .max_heading_sigma_rad = radians(12.0)};
};

/// Where a robot that has driven too far without a marker goes back to. Under a marker again it knows where
/// it is; it has learned where no marker is to be found, so that it can take another way; and by the way
/// there and back it has learned its wheels, so that it comes farther where there is no other. A value type.
class Backtrack {
 public:
  explicit Backtrack(const BacktrackOptions& options = {}) : options_(options) {}

  /// Here the robot has seen a marker that agrees with its estimate.
  void saw_marker_at(const Vec2& position_in_map);

  /// Here it has seen none.
  void saw_no_marker_at(const Vec2& position_in_map);

  /// May another be made? Not before another marker was seen, nor when too many were made.
  [[nodiscard]] bool possible() const {
    return !seen_at_m_.empty() && has_seen_ && made_ < options_.most_to_a_goal;
  }

  /// Where the next one leads to; nothing when none may be made.
  [[nodiscard]] std::optional<Vec2> place_m() const {
    return possible() ? std::optional(seen_at_m_.front()) : std::nullopt;
  }

  /// Counts a backtrack: where to. Nothing when none may be made.
  std::optional<Vec2> begin();

  /// It is where the last one led to.
  void reached_place() { found_no_marker_ = !has_seen_; }

  /// It went back to where it had seen markers, and has seen none since it left. Then it is not the ceiling:
  /// the camera sees nothing, or the robot is not where it thinks. It must not go on.
  [[nodiscard]] bool found_no_marker() const { return found_no_marker_; }

  /// Is this place of a robot that goes back far from the one it goes to? A marker seen here is another, and
  /// saves the rest of the way.
  [[nodiscard]] bool is_far_from_its_end(const Vec2& position_in_map) const {
    return (position_in_map - towards_m_).norm() > options_.markers_view_m;
  }

  /// The ground on which it has seen no marker before the backtracks made so far, in steps.
  [[nodiscard]] std::span<const Vec2> blind_places_m() const { return blind_places_m_; }

  /// To another goal.
  void new_goal() { made_ = 0; }

 private:
  BacktrackOptions options_;
  std::deque<Vec2> seen_at_m_;  ///< the last places, a step apart
  Vec2 towards_m_ = Vec2::Zero();
  std::vector<Vec2> unseen_at_m_;     ///< the places since the last marker, a step apart
  std::vector<Vec2> blind_places_m_;  ///< those that ended in a backtrack
  int made_ = 0;
  bool has_seen_ = false;  ///< a marker, since the last one began
  bool found_no_marker_ = false;
};

}  // namespace lodestar
