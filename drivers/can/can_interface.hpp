#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace lodestar {

/// Of AgileX's bases and ODrive's defaults.
inline constexpr std::uint32_t usual_can_bit_rate_bps = 500'000;

/// What the system reports about a CAN interface, without opening it.
struct CanInterface {
  bool kernel_has_can = false;
  bool exists = false;
  bool is_up = false;
  bool is_virtual = false;                       ///< has no controller, hence no bit rate and no errors
  std::optional<std::uint32_t> bit_rate_bps;     ///< empty when the query is not permitted
  std::optional<std::string> controller;         ///< its state: "error-active", "bus-off", ...
  std::optional<std::uint32_t> transmit_errors;  ///< the controller's error counters
  std::optional<std::uint32_t> receive_errors;
};

CanInterface look_at_can_interface(const std::string& name);

/// What keeps an interface from being used.
struct CanInterfaceProblem {
  std::string found;
  std::string remedy;  ///< the commands, where commands help
};
/// Empty when frames can be sent and received.
std::optional<CanInterfaceProblem> problem_of(const std::string& name, const CanInterface& seen);

/// Only whether it is switched on.
bool is_switched_on(const std::string& name);

}  // namespace lodestar
