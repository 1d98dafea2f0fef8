#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "maps/stamp.hpp"

namespace lodestar {

/// A classic CAN 2.0 data frame with an 11-bit identifier.
struct CanFrame {
  std::uint32_t id = 0;
  std::uint8_t length = 0;
  std::array<std::uint8_t, 8> data{};
  friend bool operator==(const CanFrame&, const CanFrame&) = default;
};

struct StampedCanFrame {
  Stamp stamp;  ///< of reception
  CanFrame frame;
};

/// One end of a CAN bus: a socket, or a place on the in-process bus.
class CanBus {
 public:
  CanBus() = default;
  CanBus(const CanBus&) = delete;
  CanBus& operator=(const CanBus&) = delete;
  virtual ~CanBus() = default;

  /// False when the frame could not be handed over. True is no proof that anyone got it: only feedback is.
  [[nodiscard]] virtual bool send(const CanFrame& frame) = 0;

  /// The next received frame, oldest first; nothing when none has arrived. Never blocks.
  virtual std::optional<StampedCanFrame> poll() = 0;
};

}  // namespace lodestar
