#pragma once

#include <cstdint>
#include <optional>

#include "maps/stamp.hpp"

namespace lodestar {

struct DeviceClockOptions {
  Duration tick = std::chrono::milliseconds(1);
  std::uint64_t ticks_to_wrap = 0;  ///< the device's count starts again at this number; 0: it never does
  double max_drift = 0.02;          ///< rate error of a ceramic resonator (0.5 %), and room
  /// Rate by which the estimate moves towards later arrivals while none is quicker: above what is left of the
  /// drift when it has been learned, low enough to pass over seconds of busy bus.
  double leak = 1e-4;
  Duration learning_time = std::chrono::seconds(5);  ///< between two looks at the drift
  int learning_blocks = 4;  ///< of that time, in which the offset follows the drift as it is learned
  /// A count this far ahead of all deliveries so far is another count: nothing arrives before it is measured.
  Duration impossible_lead = std::chrono::milliseconds(50);
  /// A device that seems this late for so long was restarted: no buffer holds this much.
  Duration restart_lateness = std::chrono::seconds(1);
  Duration restart_patience = std::chrono::seconds(2);
};

/// When a device measured, on the robot's clock: from the device's own count, which is regular but of unknown
/// origin and rate, and from the times of arrival, which jitter but never precede the measurement. The
/// quickest delivery so far fixes the offset, the quickest ones some seconds apart fix the rate, so that late
/// arrivals (a busy bus, a paused process) keep the time at which they were measured.
class DeviceClock {
 public:
  explicit DeviceClock(const DeviceClockOptions& options = {}) : options_(options) {}

  /// The time of `ticks` on the robot's clock, at the latest that of arrival. Arrivals are given in order. A
  /// count that runs backwards is a restart of the device, and all is learned anew.
  Stamp stamp_of(std::uint64_t ticks, Stamp arrival);

  /// Rate of the robot's clock against the device's, less one; 0 until it is learned.
  [[nodiscard]] double drift() const { return drift_; }
  [[nodiscard]] int restarts() const { return restarts_; }

 private:
  /// A delivery: the device's time since the clock's start, and when it arrived.
  struct Delivery {
    Duration device{};
    Stamp arrival;
  };

  void start(std::uint64_t ticks, Stamp arrival);
  [[nodiscard]] std::optional<Duration> elapsed(std::uint64_t ticks) const;
  [[nodiscard]] bool seems_restarted(Duration lateness, Stamp arrival);
  void learn_drift(const Delivery& delivery);

  DeviceClockOptions options_;
  bool started_ = false;
  std::uint64_t last_ticks_ = 0;
  Duration device_{};                     ///< of the last delivery
  Delivery quickest_;                     ///< fixes the offset
  Delivery quickest_of_block_;            ///< of the present learning time, by the rate known
  std::optional<Delivery> block_before_;  ///< the quickest of the learning time before
  Duration block_begin_{};
  int blocks_ = 0;
  std::optional<Stamp> late_since_;
  double drift_ = 0.0;
  int restarts_ = 0;
};

}  // namespace lodestar
