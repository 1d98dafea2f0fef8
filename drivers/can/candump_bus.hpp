#pragma once

#include <set>
#include <vector>

#include "drivers/can/can_bus.hpp"
#include "drivers/can/candump.hpp"

namespace lodestar {

/// Plays back a recorded bus. Its owner advances the time; the log's first frame arrives at `start`.
class CandumpBus final : public CanBus {
 public:
  /// `own`: identifiers that this node itself sent in the recording, and therefore did not receive.
  CandumpBus(std::vector<LoggedCanFrame> log, std::set<std::uint32_t> own, Stamp start = {});

  void advance(Stamp now) { now_ = now; }
  [[nodiscard]] bool at_end() const { return next_ >= log_.size(); }

  /// Accepts every frame and discards it.
  bool send(const CanFrame& frame) override;
  std::optional<StampedCanFrame> poll() override;
  [[nodiscard]] BusHealth health() const override { return {BusState::up, counts_}; }

 private:
  std::vector<LoggedCanFrame> log_;
  std::set<std::uint32_t> own_;
  Duration shift_{};  ///< from the log's time to the present one
  Stamp now_;
  std::size_t next_ = 0;
  BusCounts counts_;
};

}  // namespace lodestar
