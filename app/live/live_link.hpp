#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <vector>

#include "app/live/order.hpp"
#include "app/live/robot_state.hpp"

namespace lodestar {

/// Between the control loop, which must never wait, and the console's thread, which may. The control loop
/// gives a state only when one is wanted, and passes over whatever the other thread holds at that moment: the
/// next step is 20 ms away.
class LiveLink {
 public:
  // -- the control loop's side: no call waits
  // ----------------------------------------------------------------

  /// Does anybody wait for a state?
  [[nodiscard]] bool wants_state() const { return wanted_.load(std::memory_order_acquire); }
  void publish(RobotState state);
  /// What came in since the last call, oldest first.
  [[nodiscard]] std::vector<Order> take_orders();
  /// Has anybody asked to stop since the last call?
  [[nodiscard]] bool take_stop() { return stop_.exchange(false); }
  /// Is somebody at the wheel at this time of monotonic_now()?
  [[nodiscard]] bool is_held(Stamp now) const { return now.time_since_epoch().count() < held_until_.load(); }

  // -- the console's side
  // ------------------------------------------------------------------------------------

  void want_state() { wanted_.store(true, std::memory_order_release); }
  /// The state published last, once.
  [[nodiscard]] std::optional<RobotState> newest();
  /// False when too many wait already.
  [[nodiscard]] bool give(Order order);
  /// Needs no place in a queue, so it is never refused.
  void stop() { stop_.store(true); }
  void hold_until(Stamp stamp) { held_until_.store(stamp.time_since_epoch().count()); }

 private:
  std::atomic<bool> wanted_ = false;
  std::atomic<bool> stop_ = false;
  std::atomic<Duration::rep> held_until_ = 0;
  std::mutex mutex_;  ///< of all below
  std::optional<RobotState> state_;
  std::vector<Order> orders_;
};

}  // namespace lodestar
