#include "drivers/agilex_v2.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestar::agilex {
namespace {

constexpr std::uint8_t full_length = 8;

void put_u16(CanFrame& frame, std::size_t at, std::uint16_t value) {
  frame.data[at] = static_cast<std::uint8_t>(value >> 8U);
  frame.data[at + 1] = static_cast<std::uint8_t>(value & 0xFFU);
}

std::uint16_t get_u16(const CanFrame& frame, std::size_t at) {
  return static_cast<std::uint16_t>((frame.data[at] << 8U) | frame.data[at + 1]);
}

void put_i32(CanFrame& frame, std::size_t at, std::int32_t value) {
  const auto bits = static_cast<std::uint32_t>(value);
  put_u16(frame, at, static_cast<std::uint16_t>(bits >> 16U));
  put_u16(frame, at + 2, static_cast<std::uint16_t>(bits & 0xFFFFU));
}

std::int32_t get_i32(const CanFrame& frame, std::size_t at) {
  const std::uint32_t high = get_u16(frame, at);
  return static_cast<std::int32_t>((high << 16U) | get_u16(frame, at + 2));
}

/// The nearest whole number of the type, saturated; 0 for NaN.
template <typename Integer>
Integer saturated(double value) {
  using Limits = std::numeric_limits<Integer>;
  if (std::isnan(value)) return 0;
  return static_cast<Integer>(
      std::lround(std::clamp<double>(value, double{Limits::min()}, double{Limits::max()})));
}

constexpr double steps_per_unit = 1000.0;  // mm and mrad

void put_thousandths(CanFrame& frame, std::size_t at, double value) {
  put_u16(frame, at, static_cast<std::uint16_t>(saturated<std::int16_t>(value * steps_per_unit)));
}

double get_thousandths(const CanFrame& frame, std::size_t at) {
  return static_cast<std::int16_t>(get_u16(frame, at)) / steps_per_unit;
}

CanFrame velocity_frame(std::uint32_t id, const BodyVelocity& velocity) {
  CanFrame frame{id, full_length, {}};
  put_thousandths(frame, 0, velocity.forward_mps);
  put_thousandths(frame, 2, velocity.turn_radps);
  return frame;
}

bool is_frame(const CanFrame& frame, std::uint32_t id, std::uint8_t least_length) {
  return frame.id == id && frame.length >= least_length;
}

std::optional<BodyVelocity> decode_velocity(std::uint32_t id, const CanFrame& frame) {
  if (!is_frame(frame, id, full_length)) return std::nullopt;
  return BodyVelocity{get_thousandths(frame, 0), get_thousandths(frame, 2)};
}

VehicleState vehicle_state(std::uint8_t byte) {
  return byte <= static_cast<std::uint8_t>(VehicleState::exception) ? static_cast<VehicleState>(byte)
                                                                    : VehicleState::unknown;
}

ControlMode control_mode(std::uint8_t byte) {
  return byte <= static_cast<std::uint8_t>(ControlMode::remote) ? static_cast<ControlMode>(byte)
                                                                : ControlMode::unknown;
}

}  // namespace

CanFrame encode_motion_command(const BodyVelocity& velocity) {
  return velocity_frame(motion_command_id, velocity);
}

CanFrame encode_control_mode(ControlMode mode) {
  return {control_mode_id, 1, {static_cast<std::uint8_t>(mode)}};
}

CanFrame encode_clear_fault() {
  return {clear_fault_id, 1, {}};
}

CanFrame encode_system_state(const SystemState& state) {
  CanFrame frame{system_state_id, full_length, {}};
  frame.data[0] = static_cast<std::uint8_t>(state.vehicle);
  frame.data[1] = static_cast<std::uint8_t>(state.mode);
  put_u16(frame, 2, saturated<std::uint16_t>(state.battery_v * 10.0));
  put_u16(frame, 4, state.fault_bits);
  frame.data[7] = state.counter;
  return frame;
}

CanFrame encode_motion_state(const BodyVelocity& velocity) {
  return velocity_frame(motion_state_id, velocity);
}

CanFrame encode_odometer(const Odometer& odometer) {
  CanFrame frame{odometer_id, full_length, {}};
  put_i32(frame, 0, odometer.left_mm);
  put_i32(frame, 4, odometer.right_mm);
  return frame;
}

std::optional<BodyVelocity> decode_motion_command(const CanFrame& frame) {
  return decode_velocity(motion_command_id, frame);
}

std::optional<ControlMode> decode_control_mode(const CanFrame& frame) {
  if (!is_frame(frame, control_mode_id, 1)) return std::nullopt;
  return control_mode(frame.data[0]);
}

bool is_clear_fault(const CanFrame& frame) {
  return is_frame(frame, clear_fault_id, 1) && frame.data[0] == 0;
}

std::optional<SystemState> decode_system_state(const CanFrame& frame) {
  if (!is_frame(frame, system_state_id, full_length)) return std::nullopt;
  return SystemState{vehicle_state(frame.data[0]), control_mode(frame.data[1]), get_u16(frame, 2) / 10.0,
                     get_u16(frame, 4), frame.data[7]};
}

std::optional<BodyVelocity> decode_motion_state(const CanFrame& frame) {
  return decode_velocity(motion_state_id, frame);
}

std::optional<Odometer> decode_odometer(const CanFrame& frame) {
  if (!is_frame(frame, odometer_id, full_length)) return std::nullopt;
  return Odometer{get_i32(frame, 0), get_i32(frame, 4)};
}

}  // namespace lodestar::agilex
