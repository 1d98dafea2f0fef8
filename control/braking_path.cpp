#include "control/braking_path.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

constexpr double step_s = 0.03;

/// One component of the velocity: `first` until the braking takes effect, from `then` on less and less.
class Braked {
 public:
  /// Commands on their way may still differ from the one wanted: so long the faster of both counts. A base
  /// that is faster than wanted has been braking since the command.
  Braked(double measured, double wanted, double deceleration, double reaction_s)
      : deceleration_(deceleration), reaction_s_(reaction_s) {
    const bool is_reversal = measured * wanted < 0.0;
    const bool is_measured = is_reversal || std::abs(measured) > std::abs(wanted);
    first_ = is_measured ? measured : wanted;
    const double slowed = std::max(std::abs(measured) - deceleration * reaction_s, 0.0);
    then_ = std::copysign(is_reversal ? slowed : std::max(std::abs(wanted), slowed), first_);
  }

  [[nodiscard]] double at(double time_s) const {
    if (time_s <= reaction_s_) return first_;
    return std::copysign(std::max(std::abs(then_) - deceleration_ * (time_s - reaction_s_), 0.0), then_);
  }
  /// The way in the interval; the speed falls linearly except where it reaches 0, there the mean is more.
  [[nodiscard]] double between(double from_s, double to_s) const {
    const double split_s = std::clamp(reaction_s_, from_s, to_s);
    const double rest_s = std::clamp(until_rest_s(), split_s, to_s);
    const double speed = split_s > reaction_s_ ? at(split_s) : then_;
    return first_ * (split_s - from_s) +
           0.5 * (speed + (rest_s > reaction_s_ ? at(rest_s) : speed)) * (rest_s - split_s);
  }
  [[nodiscard]] double until_rest_s() const {
    if (first_ == 0.0) return 0.0;
    return reaction_s_ + std::abs(then_) / deceleration_;
  }
  [[nodiscard]] double then() const { return then_; }

 private:
  double deceleration_;
  double reaction_s_;
  double first_ = 0.0;
  double then_ = 0.0;
};

Pose2 after_arc(const Pose2& from, double length_m, double turn_rad) {
  const double middle_rad = from.yaw_rad + 0.5 * turn_rad;
  const Vec2 way(std::cos(middle_rad), std::sin(middle_rad));
  return {from.position_m + length_m * way, from.yaw_rad + turn_rad};
}

}  // namespace

double outline_speed_mps(const BodyVelocity& velocity, const RobotShape& shape) {
  const double turning_mps = std::abs(velocity.turn_radps) * shape.outer_radius_m();
  const double forward_mps = std::abs(velocity.forward_mps);
  return shape.is_disc() ? std::max(forward_mps, turning_mps) : forward_mps + turning_mps;
}

BrakingPath::BrakingPath(const BodyVelocity& measured, const BodyVelocity& wanted, const RobotShape& shape,
                         const ProtectiveFieldOptions& options) {
  const double reaction_s = options.control_step_s + options.response_s;
  const Braked forward(measured.forward_mps, wanted.forward_mps, options.deceleration_mps2, reaction_s);
  const Braked turn(measured.turn_radps, wanted.turn_radps, options.turn_deceleration_radps2, reaction_s);
  speed_mps_ = outline_speed_mps({forward.then(), turn.then()}, shape);
  is_turn_ = wanted.forward_mps == 0.0;
  const double rest_s = std::max(forward.until_rest_s(), turn.until_rest_s());
  const int count = static_cast<int>(std::ceil(rest_s / step_s));
  steps_.reserve(static_cast<std::size_t>(count));
  Pose2 at;
  for (int i = 0; i < count; ++i) {
    const double from_s = rest_s * i / count;
    const double to_s = rest_s * (i + 1) / count;
    const double middle_s = 0.5 * (from_s + to_s);
    const Pose2 middle = after_arc(at, forward.between(from_s, middle_s), turn.between(from_s, middle_s));
    const Pose2 end = after_arc(middle, forward.between(middle_s, to_s), turn.between(middle_s, to_s));
    const double speed_mps = outline_speed_mps({forward.at(from_s), turn.at(from_s)}, shape);
    steps_.push_back({to_s, speed_mps, middle, end, 0.5 * speed_mps * (to_s - from_s)});
    travel_m_ += speed_mps * (to_s - from_s);
    at = end;
  }
}

}  // namespace lodestar
