#pragma once

#include <cstdint>
#include <deque>

#include "drivers/can/can_bus.hpp"
#include "maps/motion.hpp"

namespace lodestar {

/// What an AgileX base has and tells of beside its drive: the motors, battery, lights, the remote control's
/// sticks and the version of its firmware. Clients of other makers wait for all that, or find out by it what
/// base they talk to.
class SimulatedPeriphery {
 public:
  SimulatedPeriphery(CanBus& bus, double battery_v) : bus_(bus), battery_v_(battery_v) {}

  /// A command for the lights, a question for the version; else nothing.
  void take_in(const CanFrame& frame);

  /// With every feedback of the drive, each 20 ms; what is told more rarely, with some of them.
  void send_feedback(const BodyVelocity& measured, double track_width_m);

  /// One frame of what was asked for; at every pass of the firmware, as several frames with the same
  /// identifier only follow one another.
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
