#include "drivers/simulation/moving_disc.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

constexpr double leg_radius_m = 0.06;
constexpr double half_stance_m = 0.09;  ///< from the middle of the body to the middle of a leg, sideways
/// A leg goes forward and back once for this way: 1.4 m at 1.4 m/s (Perry, "Gait analysis", 1992).
constexpr double stride_m = 1.4;
constexpr double ordinary_walk_mps = 1.4;

/// A longer step between two moments is a jump from the last key to the first, not a walk.
constexpr double fastest_walk_mps = 12.0;

}  // namespace

FollowedTrajectory::FollowedTrajectory(MovingDisc disc) : disc_(std::move(disc)) {
  const std::vector<DiscKey>& keys = disc_.trajectory.keys;
  const auto is_late = [](const DiscKey& a, const DiscKey& b) { return a.time >= b.time; };
  if (keys.empty() || std::ranges::adjacent_find(keys, is_late) != keys.end())
    throw InputError("a moving disc needs at least one key, and ascending times");
  state_.radius_m = disc_.radius_m;
  state_.has_legs = disc_.has_legs;
}

Duration FollowedTrajectory::time_in_keys(Stamp now) const {
  const std::vector<DiscKey>& keys = disc_.trajectory.keys;
  const Duration time = now.time_since_epoch();
  const Duration round = keys.back().time - keys.front().time;
  if (!disc_.trajectory.loops || time < keys.back().time || round <= Duration::zero()) return time;
  return keys.front().time + (time - keys.front().time) % round;
}

DiscState FollowedTrajectory::at(Stamp now) {
  const std::vector<DiscKey>& keys = disc_.trajectory.keys;
  const Duration time = time_in_keys(now);
  if (next_ > 0 && time < keys[next_ - 1].time) next_ = 0;  // another round
  while (next_ < keys.size() && keys[next_].time <= time) ++next_;
  const Vec2 before_m = state_.position_m;
  state_.velocity_mps = Vec2::Zero();
  if (next_ == 0 || next_ == keys.size()) {
    state_.position_m = next_ == 0 ? keys.front().position_m : keys.back().position_m;
  } else {
    const DiscKey& from = keys[next_ - 1];
    const DiscKey& to = keys[next_];
    state_.velocity_mps = (to.position_m - from.position_m) / seconds(to.time - from.time);
    state_.position_m = from.position_m + seconds(time - from.time) * state_.velocity_mps;
  }
  const double step_m = (state_.position_m - before_m).norm();
  if (has_begun_ && step_m < fastest_walk_mps) state_.walked_m += step_m;
  if (!state_.velocity_mps.isZero()) state_.heading_rad = heading_of(state_.velocity_mps);
  has_begun_ = true;
  return state_;
}

void append_visible(const DiscState& disc, std::vector<VisibleDisc>& visible) {
  if (!disc.has_legs) {
    visible.push_back({disc.position_m, disc.velocity_mps, disc.radius_m});
    return;
  }
  const double radius_m = std::min(leg_radius_m, disc.radius_m);
  const double reach_m = disc.radius_m - radius_m;
  const double aside_m = std::min(half_stance_m, reach_m);
  const double speed_mps = disc.velocity_mps.norm();
  // A leg swings as far as it stays below the body, and less in a slow walk.
  const double swing_m =
      std::sqrt(square(reach_m) - square(aside_m)) * std::min(1.0, speed_mps / ordinary_walk_mps);
  const double phase_per_m = 2.0 * std::numbers::pi / stride_m;
  const double phase_rad = phase_per_m * disc.walked_m;
  const Vec2 ahead(std::cos(disc.heading_rad), std::sin(disc.heading_rad));
  const Vec2 left(-ahead.y(), ahead.x());
  const Vec2 leg_m = swing_m * std::sin(phase_rad) * ahead + aside_m * left;
  const Vec2 swing_mps = swing_m * std::cos(phase_rad) * phase_per_m * speed_mps * ahead;
  visible.push_back({disc.position_m + leg_m, disc.velocity_mps + swing_mps, radius_m});
  visible.push_back({disc.position_m - leg_m, disc.velocity_mps - swing_mps, radius_m});
}

}  // namespace lodestar
