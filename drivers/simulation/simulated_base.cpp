#include "drivers/simulation/simulated_base.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/simulation/simulated_motion.hpp"

namespace lodestar {
namespace {

/// A 32-bit counter of millimetres that wraps around.
std::int32_t counter_mm(double travel_m, std::int32_t start_mm) {
  const auto rolled_mm = static_cast<std::int64_t>(std::floor(travel_m * 1000.0));
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(start_mm + rolled_mm));
}

}  // namespace

SimulatedBase::SimulatedBase(CanBus& bus, SimulatedMotion& motion, const SimulatedBaseOptions& options)
    : bus_(bus), motion_(motion), options_(options), periphery_(bus, options.battery_v) {}

void SimulatedBase::step(Stamp now) {
  while (const auto received = bus_.poll()) handle(received->frame, now);
  if (options_.has_periphery && !defects_.silent) periphery_.send_answer();
  drive_wheels(now);
  if (!next_feedback_) next_feedback_ = now;
  if (now < *next_feedback_) return;
  *next_feedback_ += options_.feedback_period;
  if (*next_feedback_ <= now)
    next_feedback_ = now + options_.feedback_period;  // delayed: missed frames are not made up for
  measure_speed(now);
  send_feedback();
}

void SimulatedBase::press_emergency_stop(bool pressed) {
  emergency_stop_ = pressed;
  command_.reset();
}

void SimulatedBase::set_fault_bits(std::uint16_t bits) {
  fault_bits_ = bits;
  command_.reset();
}

void SimulatedBase::take_over_by_remote(bool taken) {
  mode_ = taken ? agilex::ControlMode::remote : agilex::ControlMode::standby;
  command_.reset();
}

void SimulatedBase::set_battery_v(double battery_v) {
  options_.battery_v = battery_v;
  periphery_.set_battery_v(battery_v);
}

bool SimulatedBase::is_told_to_move() const {
  return command_ && asks_for_motion(command_->velocity);
}

void SimulatedBase::handle(const CanFrame& frame, Stamp now) {
  if (const auto velocity = agilex::decode_motion_command(frame)) {
    if (takes_commands()) command_ = Command{now, *velocity};
  } else if (const auto mode = agilex::decode_control_mode(frame)) {
    // The remote control has priority: CAN mode is not granted while it is in control.
    const bool is_grantable = *mode == agilex::ControlMode::standby || *mode == agilex::ControlMode::can ||
                              *mode == agilex::ControlMode::uart;
    if (mode_ == agilex::ControlMode::remote || !is_grantable || *mode == mode_) return;
    mode_ = *mode;
    command_.reset();
  } else if (agilex::is_clear_fault(frame)) {
    fault_bits_ = 0;
  } else if (options_.has_periphery) {
    periphery_.handle(frame);
  }
}

agilex::VehicleState SimulatedBase::vehicle_state() const {
  if (emergency_stop_) return agilex::VehicleState::emergency_stop;
  return fault_bits_ != 0 ? agilex::VehicleState::exception : agilex::VehicleState::normal;
}

bool SimulatedBase::takes_commands() const {
  return vehicle_state() == agilex::VehicleState::normal && mode_ == agilex::ControlMode::can;
}

BodyVelocity SimulatedBase::wanted_velocity(Stamp now) const {
  if (defects_.runs_away) return {options_.max_wheel_mps, 0.0};
  if (defects_.ignores_commands) return {};
  const bool has_command = command_ && now - command_->stamp <= options_.command_timeout;
  return takes_commands() && has_command ? command_->velocity : BodyVelocity{};
}

void SimulatedBase::drive_wheels(Stamp now) {
  const BodyVelocity wanted = wanted_velocity(now);
  const double half_difference_mps = wanted.turn_radps * options_.track_width_m / 2.0;
  const double left_mps = wanted.forward_mps - half_difference_mps;
  const double right_mps = wanted.forward_mps + half_difference_mps;
  const double excess = std::max({1.0, std::abs(left_mps) / options_.max_wheel_mps,
                                  std::abs(right_mps) / options_.max_wheel_mps,
                                  std::abs(wanted.forward_mps) / options_.max_forward_mps,
                                  std::abs(wanted.turn_radps) / options_.max_turn_radps});
  motion_.set_wheel_targets(left_mps / excess, right_mps / excess);
}

/// Speed from encoder steps since the last feedback, smoothed: one step in 20 ms is already 25 mm/s.
void SimulatedBase::measure_speed(Stamp now) {
  const double period_s = seconds(measured_at_ ? now - *measured_at_ : options_.feedback_period);
  measured_at_ = now;
  const double left_m = defects_.left_encoder_stuck ? last_left_m_ : motion_.left_encoder_m();
  const double right_m = motion_.right_encoder_m();
  const double left_mps = (left_m - last_left_m_) / period_s;
  const double right_mps = (right_m - last_right_m_) / period_s;
  last_left_m_ = left_m;
  last_right_m_ = right_m;

  const double share = period_s / (period_s + options_.speed_filter_s);
  measured_.forward_mps += share * ((left_mps + right_mps) / 2.0 - measured_.forward_mps);
  measured_.turn_radps += share * ((right_mps - left_mps) / options_.track_width_m - measured_.turn_radps);
}

/// A frame that the bus does not accept is dropped; the next one is newer.
void SimulatedBase::send_feedback() {
  if (defects_.silent) return;
  const agilex::SystemState state{vehicle_state(), mode_, options_.battery_v, fault_bits_, counter_};
  if (!defects_.counter_stuck) ++counter_;
  const agilex::Odometer odometer{counter_mm(last_left_m_, options_.odometer_start_mm),
                                  counter_mm(last_right_m_, options_.odometer_start_mm)};
  for (const CanFrame& frame : {agilex::encode_system_state(state), agilex::encode_motion_state(measured_),
                                agilex::encode_odometer(odometer)}) {
    if (!bus_.send(frame)) return;
  }
  if (options_.has_periphery) periphery_.send_feedback(measured_, options_.track_width_m);
}

}  // namespace lodestar
