#pragma once

#include <cstdint>
#include <optional>

#include "drivers/can_bus.hpp"
#include "maps/motion.hpp"

// AgileX protocol V2: CAN 2.0B at 500 kbit/s, 11-bit identifiers, big-endian, two's complement.
namespace lodestar::agilex {

inline constexpr std::uint32_t motion_command_id = 0x111;
inline constexpr std::uint32_t system_state_id = 0x211;
inline constexpr std::uint32_t motion_state_id = 0x221;
inline constexpr std::uint32_t odometer_id = 0x311;
inline constexpr std::uint32_t control_mode_id = 0x421;
inline constexpr std::uint32_t clear_fault_id = 0x441;

// A byte that the protocol does not name is read as `unknown`, which nobody may take for a good one.
enum class VehicleState : std::uint8_t { normal = 0, emergency_stop = 1, exception = 2, unknown = 0xFF };
enum class ControlMode : std::uint8_t { standby = 0, can = 1, uart = 2, remote = 3, unknown = 0xFF };

struct SystemState {
  VehicleState vehicle = VehicleState::normal;
  ControlMode mode = ControlMode::standby;
  double battery_v = 0.0;        ///< in steps of 0.1 V
  std::uint16_t fault_bits = 0;  ///< their meaning differs from model to model
  std::uint8_t counter = 0;      ///< one more from frame to frame, wraps around
};

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

// Nothing for another identifier or a frame shorter than the protocol says (8 bytes; the two control frames
// 1).
std::optional<BodyVelocity> decode_motion_command(const CanFrame& frame);
std::optional<ControlMode> decode_control_mode(const CanFrame& frame);
bool is_clear_fault(const CanFrame& frame);
std::optional<SystemState> decode_system_state(const CanFrame& frame);
std::optional<BodyVelocity> decode_motion_state(const CanFrame& frame);
std::optional<Odometer> decode_odometer(const CanFrame& frame);

}  // namespace lodestar::agilex
