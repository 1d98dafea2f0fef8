#pragma once

#include <cstdint>
#include <optional>

#include "drivers/base/base_state.hpp"
#include "drivers/can/can_bus.hpp"
#include "maps/motion.hpp"

// AgileX protocol V2: CAN 2.0B at 500 kbit/s, 11-bit identifiers, big-endian, two's complement. The message
// table is in agilex_v2_table.hpp.
namespace lodestar::agilex {

inline constexpr std::uint32_t motion_command_id = 0x111;
inline constexpr std::uint32_t system_state_id = 0x211;
inline constexpr std::uint32_t motion_state_id = 0x221;
inline constexpr std::uint32_t odometer_id = 0x311;
inline constexpr std::uint32_t control_mode_id = 0x421;
inline constexpr std::uint32_t clear_fault_id = 0x441;

using lodestar::ControlMode;
using lodestar::SystemState;
using lodestar::VehicleState;

/// Cumulative, wraps around at 32 bits.
struct Odometer {
  std::int32_t left_mm = 0;
  std::int32_t right_mm = 0;
};

/// Rounds to the nearest mm/s and mrad/s; saturates at the signed 16-bit range; NaN becomes 0.
CanFrame encode_motion_command(const BodyVelocity& velocity);
CanFrame encode_control_mode(ControlMode mode);
CanFrame encode_clear_fault();
CanFrame encode_system_state(const SystemState& state);
CanFrame encode_motion_state(const BodyVelocity& velocity);
CanFrame encode_odometer(const Odometer& odometer);

// Empty for another identifier or a frame shorter than the protocol requires (8 bytes; 1 for the two control
// frames).
std::optional<BodyVelocity> decode_motion_command(const CanFrame& frame);
std::optional<ControlMode> decode_control_mode(const CanFrame& frame);
bool is_clear_fault(const CanFrame& frame);
std::optional<SystemState> decode_system_state(const CanFrame& frame);
std::optional<BodyVelocity> decode_motion_state(const CanFrame& frame);
std::optional<Odometer> decode_odometer(const CanFrame& frame);

}  // namespace lodestar::agilex
