#include "drivers/scanner/byte_link.hpp"

#include <arpa/inet.h>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

constexpr std::size_t most_unsent = 4096;
constexpr int connect_patience_ms = 2000;

[[noreturn]] void refuse(const std::string& name, const std::string& wanted) {
  throw InputError(fmt::format("scanner {}: found none ({}), wanted {}", name, std::strerror(errno), wanted));
}

struct FreeAddresses {
  void operator()(addrinfo* list) const { ::freeaddrinfo(list); }
};

bool is_connected(int socket) {
  pollfd wait{.fd = socket, .events = POLLOUT, .revents = 0};
  if (::poll(&wait, 1, connect_patience_ms) <= 0) {
    errno = ETIMEDOUT;
    return false;
  }
  int error = 0;
  socklen_t size = sizeof(error);
  ::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size);
  errno = error;
  return error == 0;
}

}  // namespace

ByteView ByteLink::receive() {
  const ssize_t count = ::read(descriptor_.get(), buffer_.data(), buffer_.size());
  if (count > 0) return ByteView(buffer_).first(static_cast<std::size_t>(count));
  const bool is_nothing_yet = count < 0 && (errno == EAGAIN || errno == EINTR);
  // Of a serial line, 0 is its end; of a UDP socket, an empty datagram, which no scanner sends.
  if (!is_nothing_yet) lost_ = true;
  return {};
}

void ByteLink::send(ByteView bytes) {
  if (unsent_.size() + bytes.size() <= most_unsent) append(unsent_, bytes);
  if (unsent_.empty()) return;
  const ssize_t count = ::write(descriptor_.get(), unsent_.data(), unsent_.size());
  if (count > 0) unsent_.erase(unsent_.begin(), unsent_.begin() + count);
  if (count < 0 && errno != EAGAIN && errno != EINTR) lost_ = true;
}

ByteLink open_tcp(const std::string& host, unsigned port) {
  const std::string name = fmt::format("{}:{}", host, port);
  addrinfo wanted{};
  wanted.ai_family = AF_UNSPEC;
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wanted, &found);
      error != 0)
    throw InputError(fmt::format("scanner {}: found no such host ({}), wanted a name or address", name,
                                 ::gai_strerror(error)));
  const std::unique_ptr<addrinfo, FreeAddresses> addresses(found);
  for (const addrinfo* at = addresses.get(); at != nullptr; at = at->ai_next) {
    FileDescriptor socket(
        ::socket(at->ai_family, at->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, at->ai_protocol));
    if (!socket.is_open()) continue;
    const bool is_begun = ::connect(socket.get(), at->ai_addr, at->ai_addrlen) == 0 || errno == EINPROGRESS;
    if (is_begun && is_connected(socket.get())) return ByteLink(std::move(socket));
  }
  refuse(name, "a scanner that accepts connections");
}

ByteLink open_udp(unsigned port) {
  FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  sockaddr_in any{};
  any.sin_family = AF_INET;
  any.sin_port = htons(static_cast<std::uint16_t>(port));
  any.sin_addr.s_addr = htonl(INADDR_ANY);
  if (!socket.is_open() || ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&any), sizeof(any)) != 0)
    refuse(fmt::format("on UDP port {}", port), "a port that no other program listens on");
  return ByteLink(std::move(socket));
}

}  // namespace lodestar
