#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <vector>

#include "app/fleet/fleet_messages.hpp"
#include "app/fleet/fleet_report.hpp"

namespace lodestar {

/// Connects the control loop, which must never wait, with the thread that speaks to the broker, which may: as
/// LiveLink does for the console. Both ways are bounded: a state replaces one that has not been sent, and of
/// messages the first 256 wait.
class FleetLink {
 public:
  // -- the control loop's side: no call waits

  /// Since the last call, oldest first.
  [[nodiscard]] std::vector<FleetMessage> take_messages();
  /// False when the other side has the lock: try again in the next step.
  [[nodiscard]] bool publish(FleetReport report);
  void ask_for_factsheet() { factsheet_.store(true); }
  /// Connections to the broker since the start.
  [[nodiscard]] std::uint64_t connections() const { return connections_.load(); }

  // -- the other side

  /// False when the queue is full.
  [[nodiscard]] bool give(FleetMessage message);
  /// The newest state, handed out once.
  [[nodiscard]] std::optional<FleetReport> newest();
  [[nodiscard]] bool take_factsheet_wish() { return factsheet_.exchange(false); }
  void connected() { ++connections_; }

 private:
  std::atomic<std::uint64_t> connections_ = 0;
  std::atomic<bool> factsheet_ = false;
  std::mutex mutex_;  ///< of all below
  std::optional<FleetReport> report_;
  std::vector<FleetMessage> messages_;
};

}  // namespace lodestar
