#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "drivers/can/can_bus.hpp"
#include "drivers/simulation/fault.hpp"
#include "maps/random.hpp"

namespace lodestar {

/// An end of a CAN bus behind a bad cable: frames in both directions are lost, delayed, duplicated, or
/// replaced by others. Without a fault it changes nothing.
class FaultyBus final : public CanBus {
 public:
  FaultyBus(CanBus& bus, std::uint64_t seed) : bus_(bus), random_(seed) {}

  /// Sets the active faults; those that do not concern the bus are ignored.
  void suffer(const std::vector<Fault>& active);
  /// Delivers the frames that are due.
  void advance(Stamp now);

  bool send(const CanFrame& frame) override;
  std::optional<StampedCanFrame> poll() override;
  [[nodiscard]] BusHealth health() const override { return bus_.health(); }

 private:
  /// Queues what a frame turns into (none, one or several frames), each stamped with the time at which it is
  /// due.
  void enqueue(const StampedCanFrame& frame, std::deque<StampedCanFrame>& queue);

  CanBus& bus_;
  Random random_;
  Stamp now_;
  bool disturbed_ = false;
  double loss_ = 0.0;
  double duplication_ = 0.0;
  double corruption_ = 0.0;
  double delay_s_ = 0.0;
  std::deque<StampedCanFrame> outgoing_;
  std::deque<StampedCanFrame> incoming_;
};

}  // namespace lodestar
