#pragma once

#include <optional>
#include <span>
#include <vector>

#include "app/site/goal.hpp"
#include "control/drive_options.hpp"
#include "maps/motion.hpp"

namespace lodestar {

/// The goals of one trip: points on the way, which are passed, and the last one, where it ends. Follows which
/// of them the robot has passed, and knows the speed limits of the legs. A value.
class TripGoals {
 public:
  TripGoals() = default;
  explicit TripGoals(std::vector<Goal> goals) : goals_(std::move(goals)), led_to_(goals_.size()) {}

  /// More goals behind the last one, to which no path leads yet.
  void append(std::span<const Goal> goals);
  void path_leads_to_all() { led_to_ = goals_.size(); }

  /// The robot turns back: to move away from the next goal now is not to pass it.
  void turn_back() { nearest_m_.reset(); }
  [[nodiscard]] std::size_t beyond() const { return goals_.size() - led_to_; }

  /// Takes the robot's place, once per step.
  void see(const Vec2& robot_m);

  /// Points on the way that were passed.
  [[nodiscard]] std::size_t passed() const { return passed_; }

  /// Those before the end of the path.
  [[nodiscard]] std::size_t before_end() const { return led_to_ > 0 ? led_to_ - 1 : 0; }

  /// Those to come, to the trip's end.
  [[nodiscard]] std::span<const Goal> ahead() const { return std::span(goals_).subspan(passed_); }

  /// What the leg under way allows, or what the robot brakes from to the limit of a later one by its
  /// beginning; nothing where that is not less than the robot can. A leg begins where the robot's base frame
  /// passes the goal before, within 2.3 standard deviations of its position.
  [[nodiscard]] std::optional<double> limit_mps(const PoseEstimate& estimate,
                                                const DriveOptions& drive) const;

 private:
  std::vector<Goal> goals_;
  std::size_t led_to_ = 0;  ///< by the path
  std::size_t passed_ = 0;
  std::optional<double> nearest_m_;  ///< how near the robot has come to the next goal, where it was near
};

}  // namespace lodestar
