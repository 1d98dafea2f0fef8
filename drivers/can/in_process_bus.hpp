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
  Duration latency{};  ///< from the end of a frame on the wire until a receiver can poll it
  std::size_t transmit_queue = 16;
  std::size_t receive_queue = 4096;
};

/// A CAN bus inside one process. Frames occupy the wire for their real length, one after the other; of
/// several that wait, the lowest identifier goes first (each end sends its own in order). Its owner advances
/// the time, so equal sends give equal stamps.
class InProcessBus {
 public:
  explicit InProcessBus(const InProcessBusOptions& options = {});
  ~InProcessBus();

  /// A new end of the bus, valid as long as the bus. It receives every frame but its own. Sending fails when
  /// its transmit queue is full or the frame is invalid; frames that arrive at a full receive queue are lost
  /// and counted.
  CanBus& attach();

  /// Advances the time to `now`. Frames sent afterwards are sent at `now`.
  void advance(Stamp now);

  /// Called with every frame, stamped with its end on the wire, in bus order.
  void on_frame(std::function<void(const StampedCanFrame&)> listener) { listener_ = std::move(listener); }

  [[nodiscard]] std::uint64_t lost_frames() const { return lost_frames_; }

 private:
  class End;
  struct Sending {
    const End* sender = nullptr;
    StampedCanFrame frame;  ///< stamped with its end on the wire
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
