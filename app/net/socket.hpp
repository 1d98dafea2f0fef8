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

// WebSockets for the console: each subprotocol opens a session for each client. All of it runs on the
// server's thread.
namespace lodestar {

/// The bytes are shared: a message to many clients is built once.
struct SocketMessage {
  std::shared_ptr<const std::string> bytes;
  bool binary = false;
};

SocketMessage text_message(std::string text);

struct OutboxLimits {
  std::size_t most_messages = 256;
  std::size_t most_bytes = 16U << 20U;
};

/// The send queue of one client. A slow client gets fewer values, never older ones.
class Outbox {
 public:
  explicit Outbox(const OutboxLimits& limits = {}) : limits_(limits) {}

  /// Queues a message to be sent once, in order. Beyond the limits the outbox has overflowed and the client
  /// is disconnected.
  void queue(SocketMessage message);

  /// Queues the newest value of a slot; replaces one that has not been sent yet.
  void offer(int slot, SocketMessage message);

  /// The next message to send; nothing when the queue is empty.
  std::optional<SocketMessage> take();

  [[nodiscard]] bool overflowed() const { return overflowed_; }
  /// Number of values replaced by a newer one before they were sent.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

  /// Called whenever a message has been added.
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

/// A subprotocol's session with one client. Destroyed when the client disconnects.
class SocketSession {
 public:
  SocketSession() = default;
  SocketSession(const SocketSession&) = delete;
  SocketSession& operator=(const SocketSession&) = delete;
  virtual ~SocketSession() = default;

  /// Called with each message of the client. A session that throws ends the connection.
  virtual void receive(const std::string& bytes, bool binary) = 0;
};

struct SocketProtocol {
  std::string name;  ///< as offered in Sec-WebSocket-Protocol; empty: for clients that offer none
  /// Called for each client that offers it and has passed the access rules. The outbox outlives the session.
  std::function<std::unique_ptr<SocketSession>(Role role, Outbox& outbox)> open;
};

/// The first of `protocols` that the client offers ("a, b"); null when there is none.
const SocketProtocol* chosen_protocol(const std::vector<SocketProtocol>& protocols,
                                      const std::string& offered);

}  // namespace lodestar
