#pragma once

#include <atomic>
#include <vector>

#include "drivers/simulation/fault.hpp"

namespace lodestar {

/// State of the robot's disk in the simulated world, for the recorders that write to it. Thread-safe.
class SimulatedDisk {
 public:
  /// Applies the active faults.
  void suffer(const std::vector<Fault>& active);

  /// True when nothing more can be written.
  [[nodiscard]] bool full() const { return full_; }

  /// Duration of each write.
  [[nodiscard]] Duration delay() const { return from_seconds(delay_s_); }

 private:
  std::atomic<bool> full_ = false;
  std::atomic<double> delay_s_ = 0.0;
};

}  // namespace lodestar
