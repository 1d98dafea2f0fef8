#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "app/live/order.hpp"
#include "app/live/robot_state.hpp"

namespace lodestar {

/// Connects the control loop, which must never wait, with the console's thread, which may. The control loop
/// publishes a state only when one is wanted, and skips the exchange while the other thread holds the lock:
/// the next step is 20 ms away.
class LiveLink {
 public:
  // -- the control loop's side: no call waits

  /// Is a state wanted?
  [[nodiscard]] bool wants_state() const { return wanted_.load(std::memory_order_acquire); }
  void publish(RobotState state);
  /// Orders given since the last call, oldest first.
  [[nodiscard]] std::vector<Order> take_orders();
  /// Was a stop requested since the last call?
  [[nodiscard]] bool take_stop() { return stop_.exchange(false); }
  /// Who requested the newest; empty where nobody said, or while the other thread holds the lock.
  [[nodiscard]] std::string stopped_by();
  /// Does a client hold the control lease at this time of monotonic_now()?
  [[nodiscard]] bool is_held(Stamp now) const { return now.time_since_epoch().count() < held_until_.load(); }

  // -- the console's side

  void want_state() { wanted_.store(true, std::memory_order_release); }
  /// The newest state, handed out once.
  [[nodiscard]] std::optional<RobotState> newest();
  /// False when the queue is full.
  [[nodiscard]] bool give(Order order);
  /// Not queued, so it is never refused. `by`: who, in words.
  void stop(std::string by = {});
  void hold_until(Stamp stamp) { held_until_.store(stamp.time_since_epoch().count()); }

 private:
  std::atomic<bool> wanted_ = false;
  std::atomic<bool> stop_ = false;
  std::atomic<Duration::rep> held_until_ = 0;
  std::mutex mutex_;  ///< of all below
  std::optional<RobotState> state_;
  std::vector<Order> orders_;
  std::string stopped_by_;
};

}  // namespace lodestar
