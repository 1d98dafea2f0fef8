#include "drivers/simulated_odrive.hpp"

#include <algorithm>
#include <numbers>

#include "drivers/odrive_table.hpp"
#include "drivers/simulated_motion.hpp"

namespace lodestar {
namespace {

namespace tables = odrive::tables;

/// True once in each period; when held up, there is nothing to catch up.
bool is_due(std::optional<Stamp>& next, Stamp now, Duration period) {
  if (next && now < *next) return false;
  next = next && *next + period > now ? *next + period : now + period;
  return true;
}

}  // namespace

SimulatedOdrive::SimulatedOdrive(CanBus& bus, SimulatedMotion& motion, const SimulatedOdriveOptions& options)
    : bus_(bus), motion_(motion), options_(options) {}

void SimulatedOdrive::step(Stamp now) {
  while (const auto received = bus_.poll()) take_in(received->frame, now);
  for (Axis& axis : axes_) watch(axis, now);
  drive_wheels();
  if (is_due(next_estimate_, now, options_.estimate_period))
    send_estimates(seconds(options_.estimate_period));
  if (is_due(next_heartbeat_, now, options_.heartbeat_period)) send_heartbeats();
}

void SimulatedOdrive::take_in(const CanFrame& frame, Stamp now) {
  for (std::uint32_t node = 0; node < axes_.size(); ++node) {
    Axis& axis = axes_[node];
    const std::uint32_t offset = node * odrive::node_step;
    if (frame.id / odrive::node_step != node) continue;
    axis.fed = now;  // whatever is addressed to the axis feeds its watchdog
    if (const auto velocity = decode(tables::set_input_velocity, frame, offset)) {
      axis.wanted_rps = (*velocity)[0];
    } else if (const auto state = decode(tables::set_axis_state, frame, offset)) {
      const bool may_arm = axis.errors == 0 && !emergency_stop_;
      if ((*state)[0] == odrive::idle) axis.state = odrive::idle;
      if ((*state)[0] == odrive::closed_loop_control && may_arm) axis.state = odrive::closed_loop_control;
    } else if (decode(tables::clear_errors, frame, offset)) {
      axis.errors = emergency_stop_ ? odrive::estop_requested : 0;
    } else if (decode(tables::estop, frame, offset)) {
      disarm(odrive::estop_requested);
    }
  }
}

void SimulatedOdrive::watch(Axis& axis, Stamp now) const {
  if (!options_.watchdog || axis.state != odrive::closed_loop_control) return;
  if (axis.fed && now - *axis.fed <= *options_.watchdog) return;
  axis.state = odrive::idle;
  axis.errors |= odrive::watchdog_expired;
}

void SimulatedOdrive::disarm(std::uint32_t error) {
  for (Axis& axis : axes_) {
    axis.errors |= error;
    axis.state = odrive::idle;
  }
}

void SimulatedOdrive::press_emergency_stop(bool pressed) {
  emergency_stop_ = pressed;
  if (pressed) disarm(odrive::estop_requested);
}

void SimulatedOdrive::take_over_by_remote(bool taken) {
  if (taken) disarm(0);
}

void SimulatedOdrive::set_fault_bits(std::uint16_t bits) {
  if (bits != 0) disarm(bits);
}

bool SimulatedOdrive::is_told_to_move() const {
  return std::ranges::any_of(axes_, [](const Axis& axis) {
    return axis.state == odrive::closed_loop_control && axis.wanted_rps != 0.0;
  });
}

double SimulatedOdrive::m_per_rev() const {
  return std::numbers::pi * options_.wheel_diameter_m;
}

/// An idle axis coasts: here it rolls out as quickly as the simulated wheels slow down.
void SimulatedOdrive::drive_wheels() {
  std::array<double, 2> wanted_mps{};
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const double sign = i == 1 && options_.right_is_mirrored ? -1.0 : 1.0;
    const bool obeys = axes_[i].state == odrive::closed_loop_control && !defects_.ignores_commands;
    wanted_mps[i] = obeys ? sign * axes_[i].wanted_rps * m_per_rev() : 0.0;
    if (defects_.runs_away) wanted_mps[i] = options_.max_wheel_mps;
    wanted_mps[i] = std::clamp(wanted_mps[i], -options_.max_wheel_mps, options_.max_wheel_mps);
  }
  motion_.set_wheel_targets(wanted_mps[0], wanted_mps[1]);
}

void SimulatedOdrive::send_estimates(double elapsed_s) {
  constexpr double smoothing_s = 0.02;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = axes_[i];
    const double rolled_m = i == 0 ? motion_.left_encoder_m() : motion_.right_encoder_m();
    const double now_m = i == 0 && defects_.left_encoder_stuck ? axis.last_m : rolled_m;
    const double speed_rps = (now_m - axis.last_m) / elapsed_s / m_per_rev();
    axis.speed_rps += elapsed_s / (elapsed_s + smoothing_s) * (speed_rps - axis.speed_rps);
    axis.last_m = now_m;
    if (defects_.silent) continue;
    const double sign = i == 1 && options_.right_is_mirrored ? -1.0 : 1.0;
    (void)bus_.send(encode(tables::encoder_estimates, {sign * now_m / m_per_rev(), sign * axis.speed_rps},
                           static_cast<std::uint32_t>(i) * odrive::node_step));
  }
}

void SimulatedOdrive::send_heartbeats() {
  if (defects_.silent) return;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    (void)bus_.send(encode(tables::heartbeat,
                           {static_cast<double>(axes_[i].errors), static_cast<double>(axes_[i].state)},
                           static_cast<std::uint32_t>(i) * odrive::node_step));
  }
}

}  // namespace lodestar
