#pragma once

#include "drivers/can/can_bus.hpp"

namespace lodestar {

/// Length of a frame on the wire in bit times: from the start bit to the end of the interframe space, with
/// the stuff bits that its content and CRC actually need (ISO 11898-1; 47 to 135 bits for a valid frame).
int bits_on_wire(const CanFrame& frame);

/// True for an 11-bit identifier and at most 8 bytes.
constexpr bool is_valid(const CanFrame& frame) {
  return frame.id <= 0x7FF && frame.length <= 8;
}

}  // namespace lodestar
