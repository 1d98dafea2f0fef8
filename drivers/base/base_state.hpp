#pragma once

#include <cstdint>

// State of a base, independent of the protocol.
namespace lodestar {

// A byte that the protocol does not define is read as `unknown`, which must never be treated as a good state.
enum class VehicleState : std::uint8_t { normal = 0, emergency_stop = 1, exception = 2, unknown = 0xFF };
enum class ControlMode : std::uint8_t { standby = 0, can = 1, uart = 2, remote = 3, unknown = 0xFF };

struct SystemState {
  VehicleState vehicle = VehicleState::normal;
  ControlMode mode = ControlMode::standby;
  double battery_v = 0.0;        ///< 0 if the base does not report it
  std::uint32_t fault_bits = 0;  ///< the meaning depends on the model
  std::uint8_t counter = 0;      ///< incremented with each message, wraps around
};

}  // namespace lodestar
