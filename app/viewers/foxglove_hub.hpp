#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/net/socket.hpp"
#include "app/viewers/channel.hpp"

namespace lodestar {

/// Shows channels to Foxglove, Lichtblick and whoever else speaks its WebSocket protocol, under both of its
/// names, `foxglove.websocket.v1` and `foxglove.sdk.v1`. Viewers only look: they may subscribe and nothing
/// else. Each gets the newest message of a channel when it subscribes, and then what comes; one that is slow
/// gets fewer, except of channels where every message counts. Lives on the server's thread.
class FoxgloveHub {
 public:
  FoxgloveHub(std::string name, std::vector<Channel> channels);
  FoxgloveHub(const FoxgloveHub&) = delete;
  FoxgloveHub& operator=(const FoxgloveHub&) = delete;

  /// For the server. The hub must outlive it.
  [[nodiscard]] std::vector<SocketProtocol> protocols();

  void publish(const Message& message);

  /// Does anybody look?
  [[nodiscard]] bool has_viewers() const { return !viewers_.empty(); }
  /// Does anybody listen to this channel?
  [[nodiscard]] bool is_heard(std::size_t channel) const;

 private:
  class Viewer;

  [[nodiscard]] std::string server_info() const;
  [[nodiscard]] std::string advertisement() const;

  std::string name_;
  std::string session_;  ///< another one after each start, so that viewers forget what they know
  std::vector<Channel> channels_;
  std::vector<std::optional<Message>> newest_;  ///< by channel
  std::set<Viewer*> viewers_;
};

}  // namespace lodestar
