#pragma once

#include <optional>
#include <string>

// A WebSocket client of raw bytes, so that a test can also violate the protocol.
namespace lodestar {

class SocketClient {
 public:
  /// Connects over loopback; nothing is sent yet.
  explicit SocketClient(unsigned short port, int patience_s = 5);
  ~SocketClient();
  SocketClient(const SocketClient&) = delete;
  SocketClient& operator=(const SocketClient&) = delete;

  /// Requests the upgrade with these further headers ("Origin: ...\r\n"); returns the response's head.
  std::string upgrade(const std::string& subprotocol, const std::string& headers = "");

  /// One masked frame; opcode 1 text, 2 binary.
  void send(const std::string& payload, int opcode = 1);
  void send_bytes(const std::string& bytes) const;

  /// The next message, answering pings meanwhile; nothing when the server has closed or stays silent.
  std::optional<std::string> receive();

 private:
  std::optional<std::string> exactly(std::size_t count);

  int socket_ = -1;
  unsigned short port_;
  std::string unread_;
};

}  // namespace lodestar
