#include "drivers/scanner/served_link.hpp"

#include <arpa/inet.h>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <utility>

#include "drivers/scanner/byte_link.hpp"
#include "drivers/system/file_descriptor.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

[[noreturn]] void refuse_to_serve(const std::string& place) {
  throw InputError(fmt::format("scanner {}: found that it cannot be served ({}), wanted a place that can",
                               place, std::strerror(errno)));
}

Bytes received_from(int descriptor) {
  Bytes bytes(4096);
  const ssize_t count = ::read(descriptor, bytes.data(), bytes.size());
  bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return bytes;
}

/// Sends whole packets: what is left of one goes before the next, or else the next is lost.
class PacketQueue {
 public:
  void send(int descriptor, ByteView packet) {
    if (!rest_.empty()) write(descriptor, std::exchange(rest_, {}));
    if (rest_.empty()) write(descriptor, packet);
  }
  void clear() { rest_.clear(); }

 private:
  void write(int descriptor, ByteView bytes) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    const bool is_blocked = count < 0 && (errno == EAGAIN || errno == EINTR);
    if (count <= 0 && !is_blocked) return;
    // A packet of which nothing was written may be lost; one that was begun may not.
    if (count > 0) rest_.assign(bytes.begin() + count, bytes.end());
  }

  Bytes rest_;
};

class ServedPty final : public ServedLink {
 public:
  explicit ServedPty(std::filesystem::path link)
      : link_(std::move(link)), master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
    if (!master_.is_open() || ::grantpt(master_.get()) != 0 || ::unlockpt(master_.get()) != 0)
      refuse_to_serve(link_.string());
    const std::string device = ::ptsname(master_.get());
    std::error_code error;
    if (std::filesystem::is_symlink(link_)) std::filesystem::remove(link_, error);
    std::filesystem::create_symlink(device, link_, error);
    if (error)
      throw InputError(fmt::format("--pty: found that {} cannot be made ({}), wanted a free name",
                                   link_.string(), error.message()));
    open_serial(device, 115200);  // raw; and closed again, so that a missing client shows as a hang-up
  }
  ~ServedPty() override {
    std::error_code error;
    std::filesystem::remove(link_, error);
  }

  Bytes receive() override {
    pollfd state{.fd = master_.get(), .events = POLLIN, .revents = 0};
    ::poll(&state, 1, 0);
    const bool has_client = (state.revents & POLLHUP) == 0;
    if (has_client != has_client_) changed_ = true;
    has_client_ = has_client;
    return has_client ? received_from(master_.get()) : Bytes();
  }
  void send(ByteView packet) override {
    if (has_client_) queue_.send(master_.get(), packet);
  }
  bool client_changed() override {
    if (changed_) queue_.clear();
    return std::exchange(changed_, false);
  }

 private:
  std::filesystem::path link_;
  FileDescriptor master_;
  PacketQueue queue_;
  bool has_client_ = false;
  bool changed_ = false;
};

sockaddr_in address_of(const std::string& host, unsigned port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  const std::string number = host == "localhost" ? "127.0.0.1" : host;
  if (::inet_pton(AF_INET, number.c_str(), &address.sin_addr) != 1)
    throw InputError(fmt::format("scanner: found address '{}', wanted one such as 127.0.0.1", host));
  return address;
}

class ServedTcp final : public ServedLink {
 public:
  ServedTcp(const std::string& host, unsigned port)
      : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
    const sockaddr_in address = address_of(host, port);
    const int on = 1;
    ::setsockopt(listener_.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
    if (::bind(listener_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
        ::listen(listener_.get(), 1) != 0)
      refuse_to_serve(fmt::format("{}:{}", host, port));
  }

  Bytes receive() override {
    FileDescriptor arrived(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (arrived.is_open()) {
      const int on = 1;
      ::setsockopt(arrived.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
      client_ = std::move(arrived);
      queue_.clear();
      changed_ = true;
      return {};
    }
    return client_.is_open() ? received_from(client_.get()) : Bytes();
  }
  void send(ByteView packet) override {
    if (client_.is_open()) queue_.send(client_.get(), packet);
  }
  bool client_changed() override { return std::exchange(changed_, false); }

 private:
  FileDescriptor listener_;
  FileDescriptor client_;
  PacketQueue queue_;
  bool changed_ = false;
};

class ServedUdp final : public ServedLink {
 public:
  ServedUdp(const std::string& host, unsigned port)
      : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
    const sockaddr_in address = address_of(host, port);
    if (::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0)
      refuse_to_serve(fmt::format("{}:{}", host, port));
  }

  Bytes receive() override { return received_from(socket_.get()); }
  void send(ByteView packet) override {
    // That nobody listens is told after the next one, and is no matter.
    [[maybe_unused]] const ssize_t count = ::write(socket_.get(), packet.data(), packet.size());
  }
  bool client_changed() override { return false; }

 private:
  FileDescriptor socket_;
};

}  // namespace

std::unique_ptr<ServedLink> serve_pty(const std::filesystem::path& link) {
  return std::make_unique<ServedPty>(link);
}
std::unique_ptr<ServedLink> serve_tcp(const std::string& host, unsigned port) {
  return std::make_unique<ServedTcp>(host, port);
}
std::unique_ptr<ServedLink> serve_udp(const std::string& host, unsigned port) {
  return std::make_unique<ServedUdp>(host, port);
}

}  // namespace lodestar
