#include "drivers/base/agilex_v2.hpp"

#include "drivers/base/agilex_v2_table.hpp"

namespace lodestar::agilex {
namespace {

std::optional<BodyVelocity> decode_velocity(const MessageSpec& message, const CanFrame& frame) {
  const auto values = decode(message, frame);
  if (!values) return std::nullopt;
  return BodyVelocity{(*values)[0], (*values)[1]};
}

VehicleState vehicle_state(double value) {
  const auto byte = static_cast<std::uint8_t>(value);
  return byte <= static_cast<std::uint8_t>(VehicleState::exception) ? static_cast<VehicleState>(byte)
                                                                    : VehicleState::unknown;
}

ControlMode control_mode(double value) {
  const auto byte = static_cast<std::uint8_t>(value);
  return byte <= static_cast<std::uint8_t>(ControlMode::remote) ? static_cast<ControlMode>(byte)
                                                                : ControlMode::unknown;
}

}  // namespace

CanFrame encode_motion_command(const BodyVelocity& velocity) {
  return encode(tables::motion_command, {velocity.forward_mps, velocity.turn_radps});
}

CanFrame encode_control_mode(ControlMode mode) {
  return encode(tables::control_mode, {static_cast<double>(mode)});
}

CanFrame encode_clear_fault() {
  return encode(tables::clear_fault, {});
}

CanFrame encode_system_state(const SystemState& state) {
  return encode(tables::system_state,
                {static_cast<double>(state.vehicle), static_cast<double>(state.mode), state.battery_v,
                 static_cast<double>(state.fault_bits), static_cast<double>(state.counter)});
}

CanFrame encode_motion_state(const BodyVelocity& velocity) {
  return encode(tables::motion_state, {velocity.forward_mps, velocity.turn_radps});
}

CanFrame encode_odometer(const Odometer& odometer) {
  return encode(tables::odometer_state,
                {static_cast<double>(odometer.left_mm), static_cast<double>(odometer.right_mm)});
}

std::optional<BodyVelocity> decode_motion_command(const CanFrame& frame) {
  return decode_velocity(tables::motion_command, frame);
}

std::optional<ControlMode> decode_control_mode(const CanFrame& frame) {
  const auto values = decode(tables::control_mode, frame);
  if (!values) return std::nullopt;
  return control_mode((*values)[0]);
}

bool is_clear_fault(const CanFrame& frame) {
  const auto values = decode(tables::clear_fault, frame);
  return values && (*values)[0] == 0.0;
}

std::optional<SystemState> decode_system_state(const CanFrame& frame) {
  const auto values = decode(tables::system_state, frame);
  if (!values) return std::nullopt;
  return SystemState{vehicle_state((*values)[0]), control_mode((*values)[1]), (*values)[2],
                     static_cast<std::uint32_t>((*values)[3]), static_cast<std::uint8_t>((*values)[4])};
}

std::optional<BodyVelocity> decode_motion_state(const CanFrame& frame) {
  return decode_velocity(tables::motion_state, frame);
}

std::optional<Odometer> decode_odometer(const CanFrame& frame) {
  const auto values = decode(tables::odometer_state, frame);
  if (!values) return std::nullopt;
  return Odometer{static_cast<std::int32_t>((*values)[0]), static_cast<std::int32_t>((*values)[1])};
}

}  // namespace lodestar::agilex
