#pragma once

#include "app/live/robot_state.hpp"
#include "app/net/socket.hpp"
#include "maps/places.hpp"

namespace lodestar {

/// A subprotocol that shows the robot's state to people or their tools. Runs on the console's thread.
class LiveChannel {
 public:
  LiveChannel() = default;
  LiveChannel(const LiveChannel&) = delete;
  LiveChannel& operator=(const LiveChannel&) = delete;
  virtual ~LiveChannel() = default;

  /// One for each subprotocol name.
  [[nodiscard]] virtual std::vector<SocketProtocol> protocols() = 0;
  [[nodiscard]] virtual bool is_watched() const = 0;
  /// About 20 times a second. `fresh`: the state published since the last call; null when none was.
  virtual void pump(Stamp now, const RobotState* fresh) = 0;
  /// Called when a client has saved the site's markers. A running drive keeps those that it started with.
  virtual void take_markers(const MarkerRegistry& saved) = 0;
  /// The same for its places and zones, which a robot obeys soon after.
  virtual void take_places(const Places& /*saved*/) {}
};

}  // namespace lodestar
