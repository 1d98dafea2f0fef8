#include "tests/app/net/raw_http.hpp"

#include <arpa/inet.h>
#include <array>
#include <cerrno>
#include <sys/socket.h>
#include <unistd.h>

namespace lodestar {
namespace {

void send_all(int client, const std::string& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t more = send(client, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (more <= 0) return;
    sent += static_cast<std::size_t>(more);
  }
}

}  // namespace

int connected(unsigned short port, std::chrono::seconds patience) {
  const int client = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const timeval wait{.tv_sec = patience.count(), .tv_usec = 0};
  setsockopt(client, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
  (void)connect(client, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  return client;
}

RawAnswer exchange(unsigned short port, const std::string& bytes, std::chrono::seconds patience) {
  const int client = connected(port, patience);
  send_all(client, bytes);
  RawAnswer answer;
  std::array<char, 4096> buffer{};
  ssize_t n = 0;
  while ((n = recv(client, buffer.data(), buffer.size(), 0)) > 0)
    answer.bytes.append(buffer.data(), static_cast<std::size_t>(n));
  answer.ended_by_server = n == 0 || errno == ECONNRESET;
  close(client);
  return answer;
}

}  // namespace lodestar
