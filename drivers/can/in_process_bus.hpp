#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "drivers/can/can_bus.hpp"

namespace lodestar {

struct InProcessBusOptions {
  double bit_rate_bps = 500'000.0;
  Duration latency{};  ///< from the end of a frame on the wire until a receiver can take it
  std::size_t transmit_queue = 16;
  std::size_t receive_queue = 4096;
};

/// A CAN bus inside one process. Frames take their time on the wire, one after the other; of several that
/// wait, the lowest identifier goes first (each end sends its own in order). Its owner moves time on, so
/// the same sends give the same stamps every time.
class InProcessBus {
 public:
  explicit InProcessBus(const InProcessBusOptions& options = {});
  ~InProcessBus();

  /// A new end of the bus, which lives as long as the bus does. It hears every frame but its own. Sending
  /// fails when its transmit queue is full or the frame is not a valid one; what arrives at a full receive
  /// queue is lost, and counted.
  CanBus& attach();

  /// Moves time on to `now`. What is sent from then on is sent at `now`.
  void advance(Stamp now);

  /// Called with every frame, stamped with its end on the wire, in the order of the wire.
  void on_frame(std::function<void(const StampedCanFrame&)> listener) { listener_ = std::move(listener); }

  [[nodiscard]] std::uint64_t lost_frames() const { return lost_frames_; }

 private:
  class End;
  struct Sending {
    const End* sender = nullptr;
    StampedCanFrame frame;  ///< stamped with the end of its time on the wire
  };

  std::optional<Sending> begin_next();
  void deliver(const Sending& sent);

  InProcessBusOptions options_;
  std::vector<std::unique_ptr<End>> ends_;
  std::function<void(const StampedCanFrame&)> listener_;
  std::optional<Sending> sending_;
  Stamp now_;
  Stamp idle_since_;
  std::uint64_t lost_frames_ = 0;
};

}  // namespace lodestar
