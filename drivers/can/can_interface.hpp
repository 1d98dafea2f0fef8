#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace lodestar {

/// What the system reports about a CAN interface, without opening it.
struct CanInterface {
  bool exists = false;
  bool is_up = false;
  bool is_virtual = false;                       ///< has no controller, hence no bit rate and no errors
  std::optional<std::uint32_t> bit_rate_bps;     ///< empty when the query is not permitted
  std::optional<std::string> controller;         ///< its state: "error-active", "bus-off", ...
  std::optional<std::uint32_t> transmit_errors;  ///< the controller's error counters
  std::optional<std::uint32_t> receive_errors;
};

CanInterface look_at_can_interface(const std::string& name);

/// Only the controller state.
bool is_switched_on(const std::string& name);

}  // namespace lodestar
