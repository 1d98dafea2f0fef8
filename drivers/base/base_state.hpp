#pragma once

#include <cstdint>

// How a base stands, in words that all protocols share.
namespace lodestar {

// A byte that the protocol does not name is read as `unknown`, which nobody may take for a good one.
enum class VehicleState : std::uint8_t { normal = 0, emergency_stop = 1, exception = 2, unknown = 0xFF };
enum class ControlMode : std::uint8_t { standby = 0, can = 1, uart = 2, remote = 3, unknown = 0xFF };

struct SystemState {
  VehicleState vehicle = VehicleState::normal;
  ControlMode mode = ControlMode::standby;
  double battery_v = 0.0;        ///< 0 where the base does not tell
  std::uint32_t fault_bits = 0;  ///< their meaning differs from model to model
  std::uint8_t counter = 0;      ///< one more from state to state, wraps around
};

}  // namespace lodestar
