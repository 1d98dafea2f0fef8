#pragma once

#include <atomic>
#include <vector>

#include "drivers/simulation/fault.hpp"

namespace lodestar {

/// How the robot's disk fares in the simulated world, for those who write to it. May be asked from any
/// thread.
class SimulatedDisk {
 public:
  /// As the faults of now have it.
  void suffer(const std::vector<Fault>& active);

  /// It takes nothing.
  [[nodiscard]] bool full() const { return full_; }

  /// How long each write takes.
  [[nodiscard]] Duration delay() const { return from_seconds(delay_s_); }

 private:
  std::atomic<bool> full_ = false;
  std::atomic<double> delay_s_ = 0.0;
};

}  // namespace lodestar
