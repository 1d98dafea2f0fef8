#pragma once

#include <cstdint>
#include <deque>

#include "drivers/can/can_bus.hpp"
#include "maps/motion.hpp"

namespace lodestar {

/// What an AgileX base reports beyond its drive: motors, battery, lights, the remote control's sticks and the
/// firmware version. Third-party clients wait for these messages, or identify the base by them.
class SimulatedPeriphery {
 public:
  SimulatedPeriphery(CanBus& bus, double battery_v) : bus_(bus), battery_v_(battery_v) {}

  void set_battery_v(double battery_v) { battery_v_ = battery_v; }

  /// Handles light commands and version requests; ignores other frames.
  void handle(const CanFrame& frame);

  /// Called with every drive feedback (20 ms); slower messages are sent with some of them.
  void send_feedback(const BodyVelocity& measured, double track_width_m);

  /// One frame of the requested answers per firmware cycle, since frames with the same identifier are sent
  /// one after another.
  void send_answer();

 private:
  void answer_with_numbers();
  void answer_with_text();
  void send_motors(const BodyVelocity& measured, double track_width_m);
  void send_battery();
  void send_panel();

  CanBus& bus_;
  double battery_v_;
  std::uint64_t feedbacks_ = 0;  ///< sent so far
  std::uint8_t counter_ = 0;
  CanFrame lights_{0, 8, {}};  ///< as commanded; off at power-up
  std::deque<CanFrame> answers_;
};

}  // namespace lodestar
