#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/net/socket.hpp"
#include "app/viewers/channel.hpp"

namespace lodestar {

/// Serves channels to Foxglove, Lichtblick and other clients of the Foxglove WebSocket protocol, under both
/// of its names, `foxglove.websocket.v1` and `foxglove.sdk.v1`. Viewers may only subscribe. Each gets the
/// newest message of a channel when it subscribes, then new ones; a slow viewer gets fewer, except on
/// channels with `every_message`. Runs on the server's thread.
class FoxgloveHub {
 public:
  FoxgloveHub(std::string name, std::vector<Channel> channels);
  FoxgloveHub(const FoxgloveHub&) = delete;
  FoxgloveHub& operator=(const FoxgloveHub&) = delete;

  /// For the server. The hub must outlive it.
  [[nodiscard]] std::vector<SocketProtocol> protocols();

  void publish(const Message& message);

  /// Is any viewer connected?
  [[nodiscard]] bool has_viewers() const { return !viewers_.empty(); }
  /// Is any viewer subscribed to this channel?
  [[nodiscard]] bool is_heard(std::size_t channel) const;

 private:
  class Viewer;

  [[nodiscard]] std::string server_info() const;
  [[nodiscard]] std::string advertisement() const;

  std::string name_;
  std::string session_;  ///< new at each start, so that viewers discard their state
  std::vector<Channel> channels_;
  std::vector<std::optional<Message>> newest_;  ///< by channel
  std::set<Viewer*> viewers_;
};

}  // namespace lodestar
