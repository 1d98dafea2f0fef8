#include "drivers/base/command_following.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

double moved_towards(double from, double to, double most) {
  return from + std::clamp(to - from, -most, most);
}

bool is_between(double value, double a, double b, double tolerance) {
  return value >= std::min(a, b) - tolerance && value <= std::max(a, b) + tolerance;
}

}  // namespace

void CommandFollowing::restart(Stamp now, const BodyVelocity& measured) {
  last_ = now;
  strayed_ = {};
  slowest_ = measured;
}

bool CommandFollowing::strays(Stamp now, const BodyVelocity& commanded, const BodyVelocity& measured) {
  const Duration elapsed = std::clamp(now - last_, Duration::zero(), options_.max_interval);
  const double elapsed_s = seconds(elapsed);
  slowest_.forward_mps =
      moved_towards(slowest_.forward_mps, commanded.forward_mps, options_.min_acceleration_mps2 * elapsed_s);
  slowest_.turn_radps = moved_towards(slowest_.turn_radps, commanded.turn_radps,
                                      options_.min_turn_acceleration_radps2 * elapsed_s);
  last_ = now;

  const auto follows = [&](const FollowingTolerance& tolerance) {
    const auto at_most = [&](double most, double command) {
      return std::max(most, tolerance.share * std::abs(command));
    };
    return is_between(measured.forward_mps, slowest_.forward_mps, commanded.forward_mps,
                      at_most(tolerance.forward_mps, commanded.forward_mps)) &&
           is_between(measured.turn_radps, slowest_.turn_radps, commanded.turn_radps,
                      at_most(tolerance.turn_radps, commanded.turn_radps));
  };
  bool too_long = false;
  for (std::size_t i = 0; i < strayed_.size(); ++i) {
    const FollowingTolerance& tolerance = options_.tolerances[i];
    strayed_[i] = follows(tolerance) ? Duration::zero() : strayed_[i] + elapsed;
    too_long = too_long || strayed_[i] > tolerance.patience;
  }
  return too_long;
}

}  // namespace lodestar
