#include "drivers/base/command_following.hpp"

#include <algorithm>

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
  strayed_grossly_ = strayed_ = Duration::zero();
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

  const auto still_strayed = [&](Duration before, const FollowingTolerance& tolerance) {
    const bool follows =
        is_between(measured.forward_mps, slowest_.forward_mps, commanded.forward_mps,
                   tolerance.forward_mps) &&
        is_between(measured.turn_radps, slowest_.turn_radps, commanded.turn_radps, tolerance.turn_radps);
    return follows ? Duration::zero() : before + elapsed;
  };
  strayed_grossly_ = still_strayed(strayed_grossly_, options_.gross);
  strayed_ = still_strayed(strayed_, options_.fine);
  return strayed_grossly_ > options_.gross.patience || strayed_ > options_.fine.patience;
}

}  // namespace lodestar
