#include "drivers/can/can_bus.hpp"

namespace lodestar {

std::string_view to_string(BusState state) {
  switch (state) {
    case BusState::up:
      return "up";
    case BusState::error_passive:
      return "error-passive: many frames are damaged on the wire";
    case BusState::stalled:
      return "stalled: frames do not get onto the wire";
    case BusState::bus_off:
      return "bus-off: the controller has left the bus after too many errors";
    case BusState::down:
      return "switched off";
    case BusState::missing:
      return "missing: there is no such interface";
    case BusState::held:
      return "held by the guard";
    case BusState::guard_lost:
      return "without its guard process";
  }
  return "in an unknown state";
}

}  // namespace lodestar
