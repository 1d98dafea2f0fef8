#include "tests/app/net/socket_client.hpp"

#include <arpa/inet.h>
#include <array>
#include <sys/socket.h>
#include <unistd.h>

namespace lodestar {

SocketClient::SocketClient(unsigned short port, int patience_s)
    : socket_(::socket(AF_INET, SOCK_STREAM, 0)), port_(port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const timeval patience{.tv_sec = patience_s, .tv_usec = 0};
  setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    close(socket_);
    socket_ = -1;
  }
}

SocketClient::~SocketClient() {
  if (socket_ >= 0) close(socket_);
}

std::string SocketClient::upgrade(const std::string& subprotocol, const std::string& headers) {
  const bool names_host = headers.find("Host:") != std::string::npos;
  send_bytes(
      "GET /api/socket HTTP/1.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
      (names_host ? std::string() : "Host: 127.0.0.1:" + std::to_string(port_) + "\r\n") +
      (subprotocol.empty() ? "" : "Sec-WebSocket-Protocol: " + subprotocol + "\r\n") + headers + "\r\n");
  std::string head;
  while (!head.ends_with("\r\n\r\n")) {
    const std::optional<std::string> byte = exactly(1);
    if (!byte) break;
    head += *byte;
  }
  return head;
}

void SocketClient::send(const std::string& payload, int opcode) {
  std::string frame;
  const auto push = [&frame](std::size_t byte) { frame += static_cast<char>(byte & 0xFFU); };
  push(0x80U | static_cast<unsigned>(opcode));
  const std::size_t size = payload.size();
  const int length_bytes = size < 126 ? 0 : size < 65536 ? 2 : 8;
  push(0x80U | (length_bytes == 0 ? size : length_bytes == 2 ? 126U : 127U));
  for (int i = length_bytes - 1; i >= 0; --i) push(size >> (8U * static_cast<unsigned>(i)));
  frame += std::string(4, '\0');  // a mask of zeros
  send_bytes(frame + payload);
}

void SocketClient::send_bytes(const std::string& bytes) const {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t more = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (more <= 0) return;
    sent += static_cast<std::size_t>(more);
  }
}

std::optional<std::string> SocketClient::receive() {
  for (;;) {
    const std::optional<std::string> head = exactly(2);
    if (!head) return std::nullopt;
    const unsigned opcode = static_cast<unsigned char>((*head)[0]) & 0x0FU;
    std::size_t size = static_cast<unsigned char>((*head)[1]) & 0x7FU;
    if (size >= 126) {
      const std::optional<std::string> length = exactly(size == 126 ? 2 : 8);
      if (!length) return std::nullopt;
      size = 0;
      for (const char byte : *length) size = (size << 8U) | static_cast<unsigned char>(byte);
    }
    std::optional<std::string> payload = exactly(size);
    if (!payload || opcode == 8) return std::nullopt;
    if (opcode == 1 || opcode == 2) return payload;
    if (opcode == 9) send(*payload, 10);
  }
}

std::optional<std::string> SocketClient::exactly(std::size_t count) {
  std::array<char, 65536> buffer{};
  while (unread_.size() < count) {
    const ssize_t got = recv(socket_, buffer.data(), buffer.size(), 0);
    if (got <= 0) return std::nullopt;
    unread_.append(buffer.data(), static_cast<std::size_t>(got));
  }
  std::string bytes = unread_.substr(0, count);
  unread_.erase(0, count);
  return bytes;
}

}  // namespace lodestar
