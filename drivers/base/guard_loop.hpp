#pragma once

#include "drivers/base/guard.hpp"

// The main loop of the guard process.
namespace lodestar {

/// From the navigator to its guard.
struct GuardRequest {
  enum class Kind { send, resume, release };
  Kind kind = Kind::send;
  CanFrame frame;  ///< to send
};

/// From the guard to its navigator: the state of the bus, and a received frame, if any.
struct GuardReport {
  BusHealth health;
  bool has_frame = false;
  StampedCanFrame frame;
};

/// Forwards frames between navigator and bus until the navigator has ended and the base has been stopped.
class GuardLoop {
 public:
  GuardLoop(SocketCanBus& bus, int navigator_socket, const GuardOptions& options);
  void run();

 private:
  void wait_for_input() const;
  void take_requests();
  void take(const GuardRequest& request);
  void pass_on_frames();
  void watch_navigator();
  void repeat_stop();
  void stop_base();
  void report(const std::optional<StampedCanFrame>& frame);

  SocketCanBus& bus_;
  int navigator_;
  GuardOptions options_;
  Stamp now_;
  bool navigator_is_there_ = true;
  /// For each frame of `stop`: the newest command with its identifier differs from it.
  std::vector<bool> moves_;
  bool holds_ = false;
  bool released_ = true;  ///< not under our control: nothing commanded yet, or released
  int repeats_left_ = 0;
  Duration silence_{};  ///< of the navigator, counted only while the guard itself was running
  Stamp last_stop_;
  Stamp last_report_;
};

}  // namespace lodestar
