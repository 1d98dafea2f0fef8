#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

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

/// How a bus stands, as far as this end can tell; the worse, the later. `up` is no proof that anyone listens.
enum class BusState {
  up,
  error_passive,  ///< carries frames, but many of them are damaged on the wire
  stalled,        ///< takes our frames no more, or does not bring them onto the wire
  bus_off,        ///< the controller has left the bus after too many errors
  down,           ///< the interface is switched off
  missing,        ///< there is no such interface
  held,           ///< the guard keeps commands back until resume()
  guard_lost      ///< the guard process is gone: nothing can be sent any more
};

// In words for people.
std::string_view to_string(BusState state);

/// Since the start.
struct BusCounts {
  std::uint64_t sent = 0;          ///< handed over to the kernel
  std::uint64_t confirmed = 0;     ///< that came back as sent
  std::uint64_t refused = 0;       ///< not handed over: no room, or an older one is still waiting
  std::uint64_t received = 0;      ///< of others
  std::uint64_t lost = 0;          ///< received, but dropped before they were read
  std::uint64_t error_frames = 0;  ///< about the bus, from its controller
  std::uint64_t binds = 0;         ///< to the interface; more than one when it was gone in between
};

struct BusHealth {
  BusState state = BusState::up;
  BusCounts counts;
};

/// One end of a CAN bus: a socket, a place on the in-process bus, or a log.
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

  /// As of the last send or poll.
  [[nodiscard]] virtual BusHealth health() const { return {}; }

  /// Somebody wants to go on: commands that a guard keeps back are let through again.
  virtual void resume() {}

  /// Somebody else drives the base now: a guard must not stop it in our name.
  virtual void release() {}
};

}  // namespace lodestar
