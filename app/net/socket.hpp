#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/net/http.hpp"

// WebSockets as far as the console cares: whoever speaks a subprotocol has a session with each client. All of
// it lives on the server's thread.
namespace lodestar {

/// The bytes are shared: what many clients get is made once.
struct SocketMessage {
  std::shared_ptr<const std::string> bytes;
  bool binary = false;
};

SocketMessage text_message(std::string text);

struct OutboxLimits {
  std::size_t most_messages = 256;
  std::size_t most_bytes = 16U << 20U;
};

/// What waits to be sent to one client. A slow client gets fewer values, never older ones.
class Outbox {
 public:
  explicit Outbox(const OutboxLimits& limits = {}) : limits_(limits) {}

  /// To be sent once, in order. A client for which too much waits is not worth waiting for: it has
  /// overflowed, and is turned out.
  void queue(SocketMessage message);

  /// The newest value of a slot: takes the place of the one that still waits there, if any.
  void offer(int slot, SocketMessage message);

  /// The next to send; nothing when none waits.
  std::optional<SocketMessage> take();

  [[nodiscard]] bool overflowed() const { return overflowed_; }
  /// Values that a newer one replaced before they were sent.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

  /// Called whenever something has come in.
  void on_work(std::function<void()> wake) { wake_ = std::move(wake); }

 private:
  struct Waiting {
    std::optional<int> slot;
    SocketMessage message;
  };

  void append(Waiting waiting);

  OutboxLimits limits_;
  std::deque<Waiting> waiting_;
  std::size_t bytes_ = 0;
  bool overflowed_ = false;
  std::uint64_t dropped_ = 0;
  std::function<void()> wake_;
};

/// One client's side of a subprotocol. Destroyed when the client has gone.
class SocketSession {
 public:
  SocketSession() = default;
  SocketSession(const SocketSession&) = delete;
  SocketSession& operator=(const SocketSession&) = delete;
  virtual ~SocketSession() = default;

  /// What the client sent. A session that throws ends the connection.
  virtual void receive(const std::string& bytes, bool binary) = 0;
};

struct SocketProtocol {
  std::string name;  ///< as offered in Sec-WebSocket-Protocol
  /// Called for each client that offers it and has passed the access rules. The outbox lives longer than the
  /// session.
  std::function<std::unique_ptr<SocketSession>(Role role, Outbox& outbox)> open;
};

/// The first of `protocols` that the client offers ("a, b"); null when there is none.
const SocketProtocol* chosen_protocol(const std::vector<SocketProtocol>& protocols,
                                      const std::string& offered);

}  // namespace lodestar
