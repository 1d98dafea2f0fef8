#include "drivers/can/socketcan_bus.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/net_tstamp.h>
#include <net/if.h>
#include <sys/socket.h>

#include "drivers/can/can_interface.hpp"
#include "drivers/can/can_wire.hpp"
#include "drivers/system/clock.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

constexpr canid_t plain_data_frame = 0;
constexpr canid_t format_bits = CAN_EFF_FLAG | CAN_RTR_FLAG;

FileDescriptor open_socket(const std::string& interface) {
  FileDescriptor opened(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (opened.is_open()) return opened;
  throw InputError(
      fmt::format("socketcan:{}: found a kernel without CAN ({}), wanted one with its modules: "
                  "sudo modprobe can can-raw",
                  interface, std::strerror(errno)));
}

template <typename Value>
void set_option(int socket, int level, int name, const Value& value) {
  if (::setsockopt(socket, level, name, &value, sizeof(value)) == 0) return;
  throw InputError(fmt::format("socketcan: option {} was refused ({})", name, std::strerror(errno)));
}

/// Filters for exactly these 11-bit identifiers: data frames, and remote requests where wanted.
void set_filters(int socket, const SocketCanOptions& options) {
  const canid_t format_mask = options.takes_remote_requests ? CAN_EFF_FLAG : format_bits;
  std::vector<can_filter> filters;
  for (const std::uint32_t id : options.identifiers) filters.push_back({id, CAN_SFF_MASK | format_mask});
  if (filters.empty()) filters.push_back({plain_data_frame, format_mask});
  const auto size = static_cast<socklen_t>(filters.size() * sizeof(can_filter));
  if (::setsockopt(socket, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), size) == 0) return;
  throw InputError(fmt::format("socketcan: the filters were refused ({})", std::strerror(errno)));
}

Stamp stamp_of(const timespec& time) {
  return Stamp(std::chrono::seconds(time.tv_sec) + Duration(time.tv_nsec));
}

/// Offset of the monotonic clock from the wall clock, on which the kernel stamps. Both are read again when
/// the thread was interrupted between the two readings.
Duration monotonic_over_wall() {
  constexpr Duration at_once = std::chrono::microseconds(100);
  timespec wall_now{};
  Stamp now;
  for (int tries = 0; tries < 5; ++tries) {
    const Stamp before = monotonic_now();
    clock_gettime(CLOCK_REALTIME, &wall_now);
    now = monotonic_now();
    if (now - before < at_once) break;
  }
  return now - stamp_of(wall_now);
}

/// One message of the socket with its kernel metadata.
struct Message {
  can_frame frame{};
  bool is_own = false;
  std::optional<Stamp> wall_stamp;
  std::optional<std::uint32_t> lost;  ///< in total, since the socket was opened
};

/// Empty when there is none; errno holds the reason.
std::optional<Message> receive(int socket) {
  Message message;
  iovec part{.iov_base = &message.frame, .iov_len = sizeof(message.frame)};
  alignas(cmsghdr) std::array<char, 256> control{};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  header.msg_control = control.data();
  header.msg_controllen = control.size();
  const ssize_t size = ::recvmsg(socket, &header, MSG_DONTWAIT);
  if (size < 0) return std::nullopt;
  if (size != static_cast<ssize_t>(CAN_MTU)) {
    errno = EBADMSG;
    return std::nullopt;
  }
  message.is_own = (header.msg_flags & MSG_CONFIRM) != 0;
  for (cmsghdr* item = CMSG_FIRSTHDR(&header); item != nullptr; item = CMSG_NXTHDR(&header, item)) {
    if (item->cmsg_level != SOL_SOCKET) continue;
    if (item->cmsg_type == SO_TIMESTAMPING) {
      timespec software{};
      std::memcpy(&software, CMSG_DATA(item), sizeof(software));
      message.wall_stamp = stamp_of(software);
    } else if (item->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t lost = 0;
      std::memcpy(&lost, CMSG_DATA(item), sizeof(lost));
      message.lost = lost;
    }
  }
  return message;
}

/// The stamp on the monotonic clock. An impossible stamp, after the wall clock was set, is replaced by the
/// present time.
Stamp stamp_from(const std::optional<Stamp>& wall_stamp, std::optional<Duration>& over_wall) {
  const Stamp now = monotonic_now();
  if (!wall_stamp) return now;
  if (!over_wall) over_wall = monotonic_over_wall();
  const Stamp stamp = *wall_stamp + *over_wall;
  const bool is_possible = stamp <= now && now - stamp < std::chrono::seconds(1);
  return is_possible ? stamp : now;
}

/// A remote request carries no data, whatever its length field.
CanFrame frame_from(const can_frame& raw) {
  const bool is_request = (raw.can_id & CAN_RTR_FLAG) != 0;
  const std::uint8_t length = is_request ? 0 : std::min<std::uint8_t>(raw.can_dlc, 8);
  CanFrame frame{raw.can_id & CAN_SFF_MASK, length, {}};
  std::copy_n(raw.data, frame.length, frame.data.begin());
  return frame;
}

}  // namespace

SocketCanBus::SocketCanBus(std::string interface, const SocketCanOptions& options)
    : interface_(std::move(interface)), options_(options) {
  if (interface_.empty() || interface_.size() >= IFNAMSIZ) {
    throw InputError(
        fmt::format("socketcan: found '{}', wanted the name of an interface, such as can0", interface_));
  }
  socket_ = open_socket(interface_);
  const int socket = socket_.get();
  set_option<can_err_mask_t>(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, CAN_ERR_MASK);
  set_option<int>(socket, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, 1);
  set_option<int>(socket, SOL_SOCKET, SO_TIMESTAMPING,
                  SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE);
  set_option<int>(socket, SOL_SOCKET, SO_RXQ_OVFL, 1);
  check_interface();
}

bool SocketCanBus::send(const CanFrame& frame) {
  const auto older_waits = [&] {
    return std::ranges::any_of(waiting_, [&](const Waiting& w) { return w.id == frame.id; });
  };
  if (older_waits()) read_all();  // its confirmation may have arrived already
  if (!is_valid(frame) || bound_index_ == 0 || older_waits()) {
    refuse();
    return false;
  }
  can_frame raw{};
  raw.can_id = frame.id;
  raw.can_dlc = frame.length;
  std::copy_n(frame.data.begin(), frame.length, raw.data);
  if (::write(socket_.get(), &raw, sizeof(raw)) != static_cast<ssize_t>(sizeof(raw))) {
    handle_failure(errno);
    refuse();
    return false;
  }
  ++counts_.sent;
  refused_in_a_row_ = 0;
  waiting_.push_back({frame.id, monotonic_now()});
  return true;
}

std::optional<StampedCanFrame> SocketCanBus::poll() {
  if (arrived_.empty()) {
    check_interface();
    read_all();
  }
  if (arrived_.empty()) return std::nullopt;
  const StampedCanFrame oldest = arrived_.front();
  arrived_.pop_front();
  return oldest;
}

/// Reads everything that the kernel has for us; frames of other nodes are queued in `arrived_`.
void SocketCanBus::read_all() {
  std::optional<Duration> over_wall;
  const canid_t unwanted = options_.takes_remote_requests ? CAN_EFF_FLAG : format_bits;
  while (true) {
    const auto message = receive(socket_.get());
    if (!message) {
      const int error = errno;
      handle_failure(error);
      const bool more_may_come = error == EINTR || error == EBADMSG || error == ENETDOWN || error == ENODEV;
      if (more_may_come) continue;
      oldest_is_overdue_ =
          !waiting_.empty() && monotonic_now() - waiting_.front().sent > options_.stalled_after;
      return;
    }
    if (message->lost) counts_.lost = *message->lost;
    const can_frame& frame = message->frame;
    if ((frame.can_id & CAN_ERR_FLAG) != 0) {
      handle_error_frame(frame);
    } else if (message->is_own) {
      confirm(frame.can_id & CAN_SFF_MASK);
    } else if ((frame.can_id & unwanted) == 0) {
      ++counts_.received;
      // A bus-off controller receives nothing: if frames keep arriving, the report was wrong.
      const bool is_long_ago = disturbed_ && monotonic_now() - *disturbed_ > options_.bus_off_expires_after;
      if (state_ == BusState::bus_off && is_long_ago) state_ = BusState::up;
      const Stamp stamp = stamp_from(message->wall_stamp, over_wall);
      newest_ = std::max(newest_, stamp);  // never backwards, whatever the clocks do
      arrived_.push_back({newest_, frame_from(frame)});
    }
  }
}

BusHealth SocketCanBus::health() const {
  const bool carries = state_ == BusState::up || state_ == BusState::error_passive;
  const bool is_stalled = oldest_is_overdue_ || refused_in_a_row_ >= options_.stalled_after_refusals;
  return {carries && is_stalled ? BusState::stalled : state_, counts_};
}

/// Detects what no frame reports: an interface that was switched on again, or came back under the same name.
void SocketCanBus::check_interface() {
  const Stamp now = monotonic_now();
  while (!waiting_.empty() && now - waiting_.front().sent > options_.forget_after) waiting_.pop_front();
  if (now - refused_ > options_.forget_after) refused_in_a_row_ = 0;
  if (checked_ && now - *checked_ < options_.check_period) return;
  checked_ = now;

  const unsigned index = ::if_nametoindex(interface_.c_str());
  if (index == 0) {
    bound_index_ = 0;
    state_ = BusState::missing;
    return;
  }
  if (index != bound_index_) bind_to(index);
  if (bound_index_ == 0) return;
  if (!is_switched_on(interface_)) {
    state_ = BusState::down;
  } else if (state_ == BusState::down || state_ == BusState::missing) {
    state_ = BusState::up;
    waiting_.clear();
  } else if (state_ == BusState::bus_off) {
    recover_from_bus_off();
  } else if (state_ == BusState::error_passive && now - *disturbed_ > options_.forget_after) {
    state_ = BusState::up;
  }
}

/// Removing an interface also removes the socket's filters.
void SocketCanBus::bind_to(unsigned index) {
  set_filters(socket_.get(), options_);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(index);
  const bool bound = ::bind(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0;
  bound_index_ = bound ? index : 0;
  state_ = bound ? BusState::down : BusState::missing;
  waiting_.clear();
  if (bound) ++counts_.binds;
}

void SocketCanBus::handle_failure(int error) {
  if (error == ENETDOWN) state_ = BusState::down;
  if (error == ENODEV || error == ENXIO) {
    state_ = BusState::missing;
    bound_index_ = 0;
  }
  const bool is_gone = state_ == BusState::down || state_ == BusState::missing;
  if (is_gone) waiting_.clear();
}

void SocketCanBus::handle_error_frame(const can_frame& frame) {
  ++counts_.error_frames;
  if ((frame.can_id & CAN_ERR_BUSOFF) != 0) {
    state_ = BusState::bus_off;
    disturbed_ = monotonic_now();
    return;
  }
  const bool has_restarted = (frame.can_id & CAN_ERR_RESTARTED) != 0;
  if (has_restarted && state_ == BusState::bus_off) state_ = BusState::up;
  if ((frame.can_id & CAN_ERR_CRTL) == 0) return;
  const unsigned details = frame.data[1];
  const bool is_passive = (details & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0;
  if (is_passive && state_ == BusState::up) state_ = BusState::error_passive;
  if (is_passive) disturbed_ = monotonic_now();
  if ((details & CAN_ERR_CRTL_ACTIVE) != 0 && state_ == BusState::error_passive) state_ = BusState::up;
}

void SocketCanBus::confirm(std::uint32_t id) {
  ++counts_.confirmed;
  const auto found = std::ranges::find(waiting_, id, &Waiting::id);
  if (found != waiting_.end()) waiting_.erase(found);
}

void SocketCanBus::refuse() {
  ++counts_.refused;
  ++refused_in_a_row_;
  refused_ = monotonic_now();
}

/// Not all controllers report an automatic restart.
void SocketCanBus::recover_from_bus_off() {
  const CanInterface seen = look_at_can_interface(interface_);
  if (seen.controller == "error-active" || seen.controller == "error-warning") state_ = BusState::up;
}

}  // namespace lodestar
