#include "drivers/simulation/simulated_battery.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {

SimulatedBattery::SimulatedBattery(const SimulatedBatteryOptions& options)
    : options_(options),
      charge_(std::clamp((options.start_v - options.empty_v) / (options.full_v - options.empty_v), 0.0, 1.0)),
      voltage_v_(rest_v()) {}

double SimulatedBattery::rest_v() const {
  return std::lerp(options_.empty_v, options_.full_v, charge_);
}

double SimulatedBattery::charging_a(const Pose2& true_map_from_base) const {
  const Pose2 dock_from_base = inverse(options_.map_from_dock) * true_map_from_base;
  const bool touches = dock_from_base.position_m.norm() <= options_.reach_m &&
                       std::abs(wrap_angle(dock_from_base.yaw_rad)) <= options_.reach_rad;
  if (!touches) return 0.0;
  return std::clamp((options_.charger_end_v - rest_v()) / options_.resistance_ohm, 0.0, options_.charger_a);
}

void SimulatedBattery::step(Duration by, bool drives, const Pose2& true_map_from_base) {
  constexpr double s_per_h = 3600.0;
  const double load_a = options_.idle_a + (drives ? options_.drive_a : 0.0);
  const double current_a = charging_a(true_map_from_base) - load_a;  // into the battery
  charge_ = std::clamp(charge_ + current_a * seconds(by) / s_per_h / options_.capacity_ah, 0.0, 1.0);
  voltage_v_ = rest_v() + current_a * options_.resistance_ohm;
}

}  // namespace lodestar
