#include "drivers/simulation/truth_socket.hpp"

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "drivers/system/clock.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

constexpr Duration retry_period = std::chrono::milliseconds(200);
constexpr int socket_type = SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC;

struct PoseMessage {
  std::int64_t stamp_ns = 0;
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
};

/// An abstract socket name: it begins with a zero byte.
struct Address {
  explicit Address(const std::string& interface) {
    const std::string name = "lodestar-world-" + interface;
    address.sun_family = AF_UNIX;
    name.copy(address.sun_path + 1, sizeof(address.sun_path) - 1);
    size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  }
  [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&address); }

  sockaddr_un address{};
  socklen_t size = 0;
};

}  // namespace

TruthServer::TruthServer(const std::string& interface) : listening_(::socket(AF_UNIX, socket_type, 0)) {
  const Address address(interface);
  if (::bind(listening_.get(), address.get(), address.size) == 0 && ::listen(listening_.get(), 8) == 0)
    return;
  throw InputError(fmt::format("{}: found {}, wanted an interface without a simulated world", interface,
                               errno == EADDRINUSE ? "another simulated base on it" : std::strerror(errno)));
}

void TruthServer::tell(const TruePose& pose) {
  while (true) {
    FileDescriptor accepted(::accept4(listening_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!accepted.is_open()) break;
    listeners_.push_back(std::move(accepted));
  }
  const Pose2& at = pose.map_from_base;
  const PoseMessage message{pose.stamp.time_since_epoch().count(), at.position_m.x(), at.position_m.y(),
                            at.yaw_rad};
  std::erase_if(listeners_, [&](const FileDescriptor& listener) {
    const bool failed = ::send(listener.get(), &message, sizeof(message), MSG_NOSIGNAL) < 0;
    return failed && errno != EAGAIN;
  });
}

std::optional<TruePose> TruthListener::poll() {
  if (!socket_.is_open()) connect();
  if (!socket_.is_open()) return std::nullopt;
  PoseMessage message;
  const ssize_t size = ::recv(socket_.get(), &message, sizeof(message), 0);
  if (size == static_cast<ssize_t>(sizeof(message))) {
    return TruePose{Stamp(Duration(message.stamp_ns)), {Vec2(message.x_m, message.y_m), message.yaw_rad}};
  }
  const bool world_ended = size == 0 || (size < 0 && errno != EAGAIN && errno != EINTR);
  if (world_ended) socket_.reset();
  return std::nullopt;
}

void TruthListener::connect() {
  const Stamp now = monotonic_now();
  if (tried_ && now - *tried_ < retry_period) return;
  tried_ = now;
  FileDescriptor socket(::socket(AF_UNIX, socket_type, 0));
  const Address address(interface_);
  if (::connect(socket.get(), address.get(), address.size) == 0) socket_ = std::move(socket);
}

}  // namespace lodestar
