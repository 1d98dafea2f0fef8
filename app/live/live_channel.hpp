#pragma once

#include "app/live/robot_state.hpp"
#include "app/net/socket.hpp"

namespace lodestar {

/// A subprotocol that shows people, or their tools, what the robot is about. Lives on the console's thread.
class LiveChannel {
 public:
  LiveChannel() = default;
  LiveChannel(const LiveChannel&) = delete;
  LiveChannel& operator=(const LiveChannel&) = delete;
  virtual ~LiveChannel() = default;

  /// One for each name under which it is asked for.
  [[nodiscard]] virtual std::vector<SocketProtocol> protocols() = 0;
  [[nodiscard]] virtual bool is_watched() const = 0;
  /// About 20 times a second. `fresh`: a state that has been published since the last call; null when none.
  virtual void pump(Stamp now, const RobotState* fresh) = 0;
  /// Somebody has saved the site's markers. A robot that drives goes on by those that it began with.
  virtual void take_markers(const MarkerRegistry& saved) = 0;
};

}  // namespace lodestar
