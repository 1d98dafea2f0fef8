#include "drivers/simulation/simulated_odrive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/base/odrive_table.hpp"
#include "drivers/simulation/simulated_motion.hpp"

namespace lodestar {
namespace {

namespace odrive_tables = odrive::tables;

/// True once in each period; after a delay, missed periods are not made up for.
bool is_due(std::optional<Stamp>& next, Stamp now, Duration period) {
  if (next && now < *next) return false;
  next = next && *next + period > now ? *next + period : now + period;
  return true;
}

}  // namespace

SimulatedOdrive::SimulatedOdrive(CanBus& bus, SimulatedMotion& motion, const SimulatedOdriveOptions& options)
    : bus_(bus), motion_(motion), options_(options) {}

void SimulatedOdrive::step(Stamp now) {
  while (const auto received = bus_.poll()) handle(received->frame, now);
  if (!answers_.empty() && bus_.send(answers_.front())) answers_.pop_front();
  for (Axis& axis : axes_) watch(axis, now);
  drive_wheels();
  if (is_due(next_estimate_, now, options_.estimate_period)) send_estimates(now);
  if (is_due(next_heartbeat_, now, options_.heartbeat_period)) {
    send_heartbeats();
    send_health();
  }
}

void SimulatedOdrive::handle(const CanFrame& frame, Stamp now) {
  const bool asks_who_is_there = frame.id == odrive::address_of_all && frame.length == 0;
  for (std::uint32_t node = 0; asks_who_is_there && !defects_.silent && node < axes_.size(); ++node)
    answer(node, odrive_tables::address.id);
  for (std::uint32_t node = 0; node < axes_.size(); ++node) {
    Axis& axis = axes_[node];
    const std::uint32_t offset = node * odrive::node_step;
    if (frame.id / odrive::node_step != node) continue;
    axis.fed = now;  // every message to the axis feeds its watchdog
    if (const auto velocity = decode(odrive_tables::set_input_velocity, frame, offset)) {
      axis.wanted_rps = (*velocity)[0];
    } else if (const auto state = decode(odrive_tables::set_axis_state, frame, offset)) {
      const bool may_arm = axis.errors == 0 && !emergency_stop_;
      if ((*state)[0] == odrive::idle) axis.state = odrive::idle;
      if ((*state)[0] == odrive::closed_loop_control && may_arm) axis.state = odrive::closed_loop_control;
    } else if (const auto mode = decode(odrive_tables::set_controller_mode, frame, offset)) {
      axis.controls_velocity = (*mode)[0] == odrive::velocity_control;
    } else if (decode(odrive_tables::clear_errors, frame, offset)) {
      axis.errors = emergency_stop_ ? odrive::estop_requested : 0;
      axis.disarm_reason = axis.errors;
    } else if (decode(odrive_tables::estop, frame, offset)) {
      disarm(odrive::estop_requested);
    } else if (frame.length == 0 && !defects_.silent) {
      answer(node, frame.id - offset);
    }
  }
}

void SimulatedOdrive::watch(Axis& axis, Stamp now) const {
  if (!options_.watchdog || axis.state != odrive::closed_loop_control) return;
  if (axis.fed && now - *axis.fed <= *options_.watchdog) return;
  axis.state = odrive::idle;
  axis.errors |= odrive::watchdog_expired;
  axis.disarm_reason = odrive::watchdog_expired;
}

void SimulatedOdrive::disarm(std::uint32_t error) {
  for (Axis& axis : axes_) {
    axis.errors |= error;
    axis.disarm_reason = error;
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

/// An idle axis coasts: here it slows down like the simulated wheels with a setpoint of zero.
void SimulatedOdrive::drive_wheels() {
  std::array<double, 2> wanted_mps{};
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const double sign = i == 1 && options_.right_is_mirrored ? -1.0 : 1.0;
    const bool obeys = axes_[i].state == odrive::closed_loop_control && axes_[i].controls_velocity &&
                       !defects_.ignores_commands;
    wanted_mps[i] = obeys ? sign * axes_[i].wanted_rps * m_per_rev() : 0.0;
    if (defects_.runs_away) wanted_mps[i] = options_.max_wheel_mps;
    wanted_mps[i] = std::clamp(wanted_mps[i], -options_.max_wheel_mps, options_.max_wheel_mps);
  }
  motion_.set_wheel_targets(wanted_mps[0], wanted_mps[1]);
}

void SimulatedOdrive::send_estimates(Stamp now) {
  constexpr double smoothing_s = 0.02;
  const double elapsed_s = seconds(estimated_at_ ? now - *estimated_at_ : options_.estimate_period);
  estimated_at_ = now;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = axes_[i];
    const double rolled_m = i == 0 ? motion_.left_encoder_m() : motion_.right_encoder_m();
    const double now_m = i == 0 && defects_.left_encoder_stuck ? axis.last_m : rolled_m;
    const double speed_rps = (now_m - axis.last_m) / elapsed_s / m_per_rev();
    axis.speed_rps += elapsed_s / (elapsed_s + smoothing_s) * (speed_rps - axis.speed_rps);
    axis.last_m = now_m;
    if (defects_.silent) continue;
    const double sign = i == 1 && options_.right_is_mirrored ? -1.0 : 1.0;
    axis.position_rev = sign * now_m / m_per_rev();
    axis.velocity_rps = sign * axis.speed_rps;
    (void)bus_.send(*frame_of(static_cast<std::uint32_t>(i), odrive_tables::encoder_estimates.id));
  }
}

void SimulatedOdrive::send_heartbeats() {
  if (defects_.silent) return;
  for (std::uint32_t node = 0; node < axes_.size(); ++node)
    (void)bus_.send(*frame_of(node, odrive_tables::heartbeat.id));
}

void SimulatedOdrive::send_health() {
  if (defects_.silent) return;
  for (std::uint32_t node = 0; node < axes_.size(); ++node) {
    for (const MessageSpec& message :
         {odrive_tables::error, odrive_tables::currents, odrive_tables::temperatures,
          odrive_tables::bus_voltage_current, odrive_tables::torques, odrive_tables::powers}) {
      (void)bus_.send(*frame_of(node, message.id));
    }
  }
}

void SimulatedOdrive::answer(std::uint32_t node, std::uint32_t command) {
  constexpr std::size_t most_waiting = 64;
  const auto frame = frame_of(node, command);
  if (frame && answers_.size() < most_waiting) answers_.push_back(*frame);
}

/// The axis's answer to a request for this command; empty for commands that cannot be requested. Torque: the
/// motor of a turning wheel overcomes a constant friction; that of an idle one coasts without current.
std::optional<CanFrame> SimulatedOdrive::frame_of(std::uint32_t node, std::uint32_t command) const {
  constexpr double friction_nm = 0.2;
  constexpr double nm_per_a = 0.4;
  constexpr double room_degc = 25.0;
  const Axis& axis = axes_.at(node);
  const bool drives = axis.state == odrive::closed_loop_control && axis.velocity_rps != 0.0;
  const double torque_nm = drives ? std::copysign(friction_nm, axis.velocity_rps) : 0.0;
  const double power_w = torque_nm * 2.0 * std::numbers::pi * axis.velocity_rps;
  const auto said = [&](const MessageSpec& message, const SignalValues& values) {
    return encode(message, values, node * odrive::node_step);
  };
  switch (command) {
    case odrive_tables::version.id:
      return said(odrive_tables::version, {2, 4, 4, 58, 0, 6, 9, 0});
    case odrive_tables::heartbeat.id:
      return said(odrive_tables::heartbeat,
                  {static_cast<double>(axis.errors), static_cast<double>(axis.state)});
    case odrive_tables::error.id:
      return said(odrive_tables::error,
                  {static_cast<double>(axis.errors), static_cast<double>(axis.disarm_reason)});
    case odrive_tables::address.id:
      return said(odrive_tables::address, {static_cast<double>(node), static_cast<double>(options_.serial)});
    case odrive_tables::encoder_estimates.id:
      return said(odrive_tables::encoder_estimates, {axis.position_rev, axis.velocity_rps});
    case odrive_tables::currents.id:
      return said(odrive_tables::currents, {torque_nm / nm_per_a, torque_nm / nm_per_a});
    case odrive_tables::temperatures.id:
      return said(odrive_tables::temperatures, {room_degc, room_degc});
    case odrive_tables::bus_voltage_current.id:
      return said(odrive_tables::bus_voltage_current, {options_.supply_v, power_w / options_.supply_v});
    case odrive_tables::torques.id:
      return said(odrive_tables::torques, {torque_nm, torque_nm});
    case odrive_tables::powers.id:
      return said(odrive_tables::powers, {power_w, power_w});
    default:
      return std::nullopt;
  }
}

}  // namespace lodestar
