#include "drivers/can/can_interface.hpp"

#include <array>
#include <fmt/format.h>
#include <libsocketcan.h>
#include <linux/can.h>
#include <linux/ethtool.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <string_view>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include "drivers/system/file_descriptor.hpp"

namespace lodestar {
namespace {

/// Any socket serves for interface queries.
FileDescriptor query_socket() {
  return FileDescriptor(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
}

bool is_virtual(const std::string& name) {
  ethtool_drvinfo info{};
  info.cmd = ETHTOOL_GDRVINFO;
  ifreq request{};
  name.copy(request.ifr_name, IFNAMSIZ - 1);
  request.ifr_data = reinterpret_cast<char*>(&info);
  if (::ioctl(query_socket().get(), SIOCETHTOOL, &request) != 0) return false;
  const std::string_view driver(info.driver);
  return driver == "vcan" || driver == "vxcan";
}

bool kernel_has_can() {
  return FileDescriptor(::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW)).is_open();
}

std::string name_of_state(int state) {
  constexpr std::array<const char*, 6> names{"error-active", "error-warning", "error-passive",
                                             "bus-off",      "stopped",       "sleeping"};
  const auto index = static_cast<std::size_t>(state);
  return index < names.size() ? names.at(index) : "unknown";
}

}  // namespace

bool is_switched_on(const std::string& name) {
  ifreq request{};
  name.copy(request.ifr_name, IFNAMSIZ - 1);
  return ::ioctl(query_socket().get(), SIOCGIFFLAGS, &request) == 0 && (request.ifr_flags & IFF_UP) != 0;
}

CanInterface look_at_can_interface(const std::string& name) {
  CanInterface seen;
  seen.kernel_has_can = kernel_has_can();
  seen.exists = name.size() < IFNAMSIZ && ::if_nametoindex(name.c_str()) != 0;
  if (!seen.exists) return seen;
  seen.is_up = is_switched_on(name);
  seen.is_virtual = is_virtual(name);
  if (seen.is_virtual) return seen;
  can_bittiming timing{};
  if (can_get_bittiming(name.c_str(), &timing) == 0 && timing.bitrate != 0)
    seen.bit_rate_bps = timing.bitrate;
  int state = 0;
  if (can_get_state(name.c_str(), &state) == 0) seen.controller = name_of_state(state);
  can_berr_counter errors{};
  if (can_get_berr_counter(name.c_str(), &errors) == 0) {
    seen.transmit_errors = errors.txerr;
    seen.receive_errors = errors.rxerr;
  }
  return seen;
}

std::optional<CanInterfaceProblem> problem_of(const std::string& name, const CanInterface& seen) {
  const bool wants_virtual = name.starts_with("vcan");
  if (!seen.kernel_has_can) {
    return CanInterfaceProblem{"this kernel has no CAN",
                               "sudo modprobe can can-raw; where there are no such modules, as in many "
                               "containers, a kernel that has them"};
  }
  if (!seen.exists) {
    return CanInterfaceProblem{
        name + " does not exist",
        wants_virtual ? fmt::format("sudo ip link add dev {0} type vcan && sudo ip link set {0} up", name)
                      : "plug in the CAN adapter, or name another interface: ip link"};
  }
  if (seen.is_up) return std::nullopt;
  return CanInterfaceProblem{name + " is down",
                             wants_virtual ? fmt::format("sudo ip link set {} up", name)
                                           : fmt::format("sudo ip link set {} up type can bitrate {}", name,
                                                         usual_can_bit_rate_bps)};
}

}  // namespace lodestar
