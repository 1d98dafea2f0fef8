#pragma once

#include <functional>
#include <utility>

#include "drivers/can/can_bus.hpp"
#include "drivers/system/clock.hpp"

namespace lodestar {

/// Passes every frame, sent or received, to a listener as well.
class RecordedBus final : public CanBus {
 public:
  using Listener = std::function<void(const StampedCanFrame&)>;
  RecordedBus(CanBus& bus, Listener listener) : bus_(bus), listener_(std::move(listener)) {}

  bool send(const CanFrame& frame) override {
    const bool sent = bus_.send(frame);
    if (sent) listener_({monotonic_now(), frame});
    return sent;
  }
  std::optional<StampedCanFrame> poll() override {
    auto received = bus_.poll();
    if (received) listener_(*received);
    return received;
  }
  [[nodiscard]] BusHealth health() const override { return bus_.health(); }
  void resume() override { bus_.resume(); }
  void release() override { bus_.release(); }

 private:
  CanBus& bus_;
  Listener listener_;
};

}  // namespace lodestar
