#pragma once

#include "drivers/can/can_bus.hpp"

namespace lodestar {

/// How long a frame keeps the bus busy, in bit times: start bit to the end of the interframe space, with the
/// stuff bits that its content and check sum really need (ISO 11898-1; 47 to 135 bits for a valid frame).
int bits_on_wire(const CanFrame& frame);

/// May stand on the bus: an 11-bit identifier and at most 8 bytes.
constexpr bool is_valid(const CanFrame& frame) {
  return frame.id <= 0x7FF && frame.length <= 8;
}

}  // namespace lodestar
