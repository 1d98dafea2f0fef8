#include "drivers/simulation/simulated_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "drivers/simulation/disc_contact.hpp"

namespace lodestar {
namespace {

/// Motion of the base when its wheels roll these distances at constant speed: an exact arc.
Pose2 arc(double left_m, double right_m, double track_width_m) {
  const double length_m = (left_m + right_m) / 2.0;
  const double turn_rad = (right_m - left_m) / track_width_m;
  const double half_rad = turn_rad / 2.0;
  const double chord_over_arc = half_rad == 0.0 ? 1.0 : std::sin(half_rad) / half_rad;
  const double chord_m = length_m * chord_over_arc;
  return {Vec2(chord_m * std::cos(half_rad), chord_m * std::sin(half_rad)), turn_rad};
}

}  // namespace

SimulatedMotion::SimulatedMotion(const SimulatedBaseOptions& options, const Pose2& start, std::uint64_t seed,
                                 std::optional<Surroundings> surroundings)
    : options_(options), surroundings_(std::move(surroundings)), slip_(seed), map_from_base_(start) {}

void SimulatedMotion::set_wheel_targets(double left_mps, double right_mps) {
  left_.target_mps = left_mps;
  right_.target_mps = right_mps;
}

void SimulatedMotion::change_surroundings(const OccupancyMap& map) {
  if (surroundings_) surroundings_->map = map;
}

void SimulatedMotion::slip(double left_share, double right_share) {
  left_.slipping_share = left_share;
  right_.slipping_share = right_share;
}

void SimulatedMotion::carry_off(double by_m, double turn_rad, Random random) {
  constexpr int directions = 32;
  // Candidates in all directions. The robot may be rolling: if possible it is placed no nearer to a wall than
  // the distance that it needs to notice and to stop.
  constexpr std::array rooms_m{0.65, 0.5, 0.4, 0.3};
  std::vector<Vec2> places_m;
  const double first_rad = random.uniform(0.0, 2.0 * std::numbers::pi);
  for (int i = 0; i < directions; ++i) {
    const double direction_rad = first_rad + 2.0 * std::numbers::pi * i / directions;
    places_m.emplace_back(map_from_base_.position_m +
                          by_m * Vec2(std::cos(direction_rad), std::sin(direction_rad)));
  }
  for (const double room_m : rooms_m) {
    const auto free = std::ranges::find_if(places_m, [&](const Vec2& place_m) {
      return !surroundings_ ||
             !disc_overlaps_obstacle(surroundings_->map, place_m, surroundings_->robot_radius_m + room_m);
    });
    if (free == places_m.end()) continue;
    map_from_base_ = {*free, wrap_angle(map_from_base_.yaw_rad + turn_rad)};
    return;
  }
}

void SimulatedMotion::step(Duration by) {
  const double elapsed_s = seconds(by);
  const double left_m = roll(left_, options_.left_wheel_scale, elapsed_s);
  const double right_m = roll(right_, options_.right_wheel_scale, elapsed_s);
  move(left_m, right_m);
}

/// Turns the wheel and returns its travel over ground: scaled by its true radius, and with slip. The variance
/// of the slip grows with the distance rolled, so that its sum does not depend on the step size.
double SimulatedMotion::roll(Wheel& wheel, double scale, double elapsed_s) {
  const double wanted_mps2 = (wheel.target_mps - wheel.speed_mps) / std::max(options_.motor_lag_s, elapsed_s);
  const double most_mps2 = options_.max_wheel_acceleration_mps2;
  const double speed_before_mps = wheel.speed_mps;
  wheel.speed_mps += std::clamp(wanted_mps2, -most_mps2, most_mps2) * elapsed_s;
  // The exponential decay never reaches zero; a real wheel stops by static friction.
  if (wheel.target_mps == 0.0 && std::abs(wheel.speed_mps) < 1e-4) wheel.speed_mps = 0.0;

  const double rolled_m = (speed_before_mps + wheel.speed_mps) / 2.0 * elapsed_s;
  wheel.rolled_m += rolled_m;
  if (rolled_m == 0.0) return 0.0;
  return rolled_m * scale * (1.0 - wheel.slipping_share) +
         options_.slip_sigma_per_sqrt_m * std::sqrt(std::abs(rolled_m)) * slip_.normal();
}

/// A disc that would hit an obstacle turns but does not translate; a footprint does neither. A robot that
/// overlaps an obstacle already, because it was placed there, may move freely.
void SimulatedMotion::move(double left_m, double right_m) {
  Pose2 moved = map_from_base_ * arc(left_m, right_m, options_.true_track_width_m);
  const bool is_disc = !surroundings_ || !surroundings_->footprint;
  const bool moves =
      moved.position_m != map_from_base_.position_m || (!is_disc && moved.yaw_rad != map_from_base_.yaw_rad);
  blocked_ = moves && overlaps_obstacle(moved) && !overlaps_obstacle(map_from_base_);
  if (blocked_) moved.position_m = map_from_base_.position_m;
  if (blocked_ && !is_disc) moved.yaw_rad = map_from_base_.yaw_rad;
  map_from_base_ = moved;
}

bool SimulatedMotion::overlaps_obstacle(const Pose2& map_from_base) const {
  if (!surroundings_) return false;
  const auto& [map, radius_m, footprint] = *surroundings_;
  return footprint ? !footprint->is_clear(map, map_from_base)
                   : disc_overlaps_obstacle(map, map_from_base.position_m, radius_m);
}

double SimulatedMotion::encoder_m(const Wheel& wheel) const {
  return std::floor(wheel.rolled_m / options_.encoder_step_m) * options_.encoder_step_m;
}

double SimulatedMotion::left_encoder_m() const {
  return encoder_m(left_);
}

double SimulatedMotion::right_encoder_m() const {
  return encoder_m(right_);
}

}  // namespace lodestar
