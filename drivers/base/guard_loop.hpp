#pragma once

#include "drivers/base/guard.hpp"

// The inside of the guard process.
namespace lodestar {

/// From the navigator to its guard.
struct GuardRequest {
  enum class Kind { send, resume, release };
  Kind kind = Kind::send;
  CanFrame frame;  ///< to send
};

/// From the guard to its navigator: how the bus stands, and what was heard, if anything.
struct GuardReport {
  BusHealth health;
  bool has_frame = false;
  StampedCanFrame frame;
};

/// Passes frames on between the navigator and the bus until the navigator is gone and the base was stopped.
class GuardLoop {
 public:
  GuardLoop(SocketCanBus& bus, int navigator_socket, const GuardOptions& options);
  void run();

 private:
  void wait_for_something() const;
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
  std::vector<bool> moves_;  ///< for each frame of `stop`: the newest command of its identifier is another
  bool holds_ = false;
  bool released_ = true;  ///< the base is not ours: nothing has been commanded yet, or it was given away
  int repeats_left_ = 0;
  Duration silence_{};  ///< of the navigator, as far as the guard itself was awake
  Stamp last_stop_;
  Stamp last_report_;
};

}  // namespace lodestar
