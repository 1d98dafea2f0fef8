#include "drivers/base/base_protocol.hpp"

#include <fmt/format.h>

namespace lodestar {

std::vector<std::string> BaseProtocol::fault_names(std::uint32_t bits) const {
  std::vector<std::string> names;
  for (const FaultBit& known : known_fault_bits()) {
    if ((bits & known.bit) != 0) names.emplace_back(known.name);
    bits &= ~known.bit;
  }
  if (bits != 0) names.push_back(fmt::format("unknown fault bits 0x{:04X}", bits));
  return names;
}

std::uint32_t BaseProtocol::warning_bits() const {
  std::uint32_t bits = 0;
  for (const FaultBit& known : known_fault_bits()) {
    if (!known.stops) bits |= known.bit;
  }
  return bits;
}

}  // namespace lodestar
