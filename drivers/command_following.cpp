#include "drivers/command_following.hpp"

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
  strayed_ = Duration::zero();
  slowest_ = measured;
}

bool CommandFollowing::strays(Stamp now, const BodyVelocity& commanded, const BodyVelocity& measured) {
  const Duration elapsed = std::clamp(now - last_, Duration::zero(), options_.longest_look);
  const double elapsed_s = seconds(elapsed);
  slowest_.forward_mps = moved_towards(slowest_.forward_mps, commanded.forward_mps,
                                       options_.least_acceleration_mps2 * elapsed_s);
  slowest_.turn_radps = moved_towards(slowest_.turn_radps, commanded.turn_radps,
                                      options_.least_turn_acceleration_radps2 * elapsed_s);
  last_ = now;

  const bool follows = is_between(measured.forward_mps, slowest_.forward_mps, commanded.forward_mps,
                                  options_.max_forward_error_mps) &&
                       is_between(measured.turn_radps, slowest_.turn_radps, commanded.turn_radps,
                                  options_.max_turn_error_radps);
  strayed_ = follows ? Duration::zero() : strayed_ + elapsed;
  return strayed_ > options_.patience;
}

}  // namespace lodestar
