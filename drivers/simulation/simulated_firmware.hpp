#pragma once

#include <cstdint>

#include "maps/stamp.hpp"

namespace lodestar {

/// Defects of a base that it does not report itself.
struct BaseDefects {
  bool silent = false;              ///< sends nothing
  bool counter_stuck = false;       ///< the system state repeats its counter
  bool ignores_commands = false;    ///< stands still
  bool runs_away = false;           ///< drives forward, whatever is commanded
  bool left_encoder_stuck = false;  ///< the wheel turns, its encoder does not count
};

/// The firmware of a base on the simulated wheels, for any protocol.
class SimulatedFirmware {
 public:
  SimulatedFirmware() = default;
  SimulatedFirmware(const SimulatedFirmware&) = delete;
  SimulatedFirmware& operator=(const SimulatedFirmware&) = delete;
  virtual ~SimulatedFirmware() = default;

  /// One cycle of the firmware's loop; to be called often, at a steady rate.
  virtual void step(Stamp now) = 0;

  // External events and defects.
  virtual void press_emergency_stop(bool pressed) = 0;
  virtual void take_over_by_remote(bool taken) = 0;  ///< when released, the base is in standby
  virtual void set_fault_bits(std::uint16_t bits) = 0;
  BaseDefects& defects() { return defects_; }

  /// True when the newest command is not zero.
  [[nodiscard]] virtual bool is_told_to_move() const = 0;

 protected:
  BaseDefects defects_;
};

}  // namespace lodestar
