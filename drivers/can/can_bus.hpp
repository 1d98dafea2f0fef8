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
  Stamp stamp;  ///< time of reception
  CanFrame frame;
};

/// State of a bus, as far as this node can tell, ordered by severity. `up` does not prove that another node
/// listens.
enum class BusState {
  up,
  error_passive,  ///< carries frames, but many are damaged on the wire
  stalled,        ///< no longer accepts our frames, or does not get them onto the wire
  bus_off,        ///< the controller has left the bus after too many errors
  down,           ///< the interface is switched off
  missing,        ///< the interface does not exist
  held,           ///< the guard blocks commands until resume()
  guard_lost      ///< the guard process has ended: nothing can be sent
};

// A description for messages.
std::string_view to_string(BusState state);

/// Frame counts since the start.
struct BusCounts {
  std::uint64_t sent = 0;          ///< accepted by the kernel
  std::uint64_t confirmed = 0;     ///< looped back by the kernel after transmission
  std::uint64_t refused = 0;       ///< not accepted: no room, or an older frame is still waiting
  std::uint64_t received = 0;      ///< from other nodes
  std::uint64_t lost = 0;          ///< received, but dropped before being read
  std::uint64_t error_frames = 0;  ///< reported by the controller
  std::uint64_t binds = 0;         ///< to the interface; more than one when it had disappeared in between
};

struct BusHealth {
  BusState state = BusState::up;
  BusCounts counts;
};

/// A node's connection to a CAN bus: a socket, an end of the in-process bus, or a log.
class CanBus {
 public:
  CanBus() = default;
  CanBus(const CanBus&) = delete;
  CanBus& operator=(const CanBus&) = delete;
  virtual ~CanBus() = default;

  /// False when the frame was not accepted. True does not prove that any node received it; only feedback
  /// does.
  [[nodiscard]] virtual bool send(const CanFrame& frame) = 0;

  /// The oldest received frame not yet polled; empty when there is none. Never blocks.
  virtual std::optional<StampedCanFrame> poll() = 0;

  /// As of the last send or poll.
  [[nodiscard]] virtual BusHealth health() const { return {}; }

  /// The operator resumes: a guard passes commands on again.
  virtual void resume() {}

  /// The base is now controlled by someone else: a guard must not stop it on our behalf.
  virtual void release() {}
};

}  // namespace lodestar
