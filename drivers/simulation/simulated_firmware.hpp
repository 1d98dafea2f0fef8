#pragma once

#include <cstdint>

#include "maps/stamp.hpp"

namespace lodestar {

/// What can be broken in a base, besides what it reports itself.
struct BaseDefects {
  bool silent = false;              ///< sends nothing
  bool counter_stuck = false;       ///< the system state repeats its counter
  bool ignores_commands = false;    ///< stands
  bool runs_away = false;           ///< drives ahead, whatever it is told
  bool left_encoder_stuck = false;  ///< the wheel turns, its count does not
};

/// The firmware of a base over the simulated wheels, whichever protocol it speaks.
class SimulatedFirmware {
 public:
  SimulatedFirmware() = default;
  SimulatedFirmware(const SimulatedFirmware&) = delete;
  SimulatedFirmware& operator=(const SimulatedFirmware&) = delete;
  virtual ~SimulatedFirmware() = default;

  /// One pass of the firmware's loop; to be called often, at a steady rate.
  virtual void step(Stamp now) = 0;

  // What people, wear and the shop floor do to a base.
  virtual void press_emergency_stop(bool pressed) = 0;
  virtual void take_over_by_remote(bool taken) = 0;  ///< given back, the base stands by
  virtual void set_fault_bits(std::uint16_t bits) = 0;
  BaseDefects& defects() { return defects_; }

  /// The newest command is not zero.
  [[nodiscard]] virtual bool is_told_to_move() const = 0;

 protected:
  BaseDefects defects_;
};

}  // namespace lodestar
