#include "drivers/simulation/simulated_periphery.hpp"

#include <string_view>

#include "drivers/base/agilex_v2_table.hpp"

namespace lodestar {
namespace {

namespace agilex_tables = agilex::tables;

constexpr double room_degc = 25.0;
constexpr double charge_percent = 80.0;
constexpr double healthy_percent = 100.0;
constexpr std::uint8_t asks = 1;

}  // namespace

void SimulatedPeriphery::handle(const CanFrame& frame) {
  if (decode(agilex_tables::light_command, frame)) {
    lights_ = frame;
  } else if (decode(agilex_tables::version_request, frame)) {
    answer_with_numbers();
  } else if (frame.id == agilex_tables::version_text.id && frame.length == 1 && frame.data[0] == asks) {
    answer_with_text();
  }
}

void SimulatedPeriphery::answer_with_numbers() {
  constexpr double version_1_0 = 0x0100;  // the high byte is the major version
  answers_.push_back(
      encode(agilex_tables::version_answer, {version_1_0, version_1_0, version_1_0, version_1_0}));
}

/// Eighty characters in ten frames.
void SimulatedPeriphery::answer_with_text() {
  constexpr std::string_view text = "LODESTAR SIMULATED BASE H1.0 S1.0";
  constexpr std::size_t letters = 80;
  for (std::size_t at = 0; at < letters; at += agilex_tables::version_letters.size()) {
    CanFrame frame{agilex_tables::version_text.id, agilex_tables::version_text.length, {}};
    for (std::size_t i = 0; i < frame.data.size(); ++i) {
      frame.data[i] = at + i < text.size() ? static_cast<std::uint8_t>(text[at + i]) : ' ';
    }
    answers_.push_back(frame);
  }
}

void SimulatedPeriphery::send_answer() {
  if (!answers_.empty() && bus_.send(answers_.front())) answers_.pop_front();
}

void SimulatedPeriphery::send_feedback(const BodyVelocity& measured, double track_width_m) {
  constexpr int slow = 5;        // each 100 ms
  constexpr int very_slow = 25;  // each 500 ms
  send_motors(measured, track_width_m);
  send_panel();
  if (feedbacks_ % slow == 0) {
    (void)bus_.send(encode(agilex_tables::motor1_slow, {battery_v_, room_degc, room_degc}));
    (void)bus_.send(encode(agilex_tables::motor2_slow, {battery_v_, room_degc, room_degc}));
  }
  if (feedbacks_ % very_slow == 0) send_battery();
  ++feedbacks_;
}

void SimulatedPeriphery::send_motors(const BodyVelocity& measured, double track_width_m) {
  constexpr double rim_m_per_turn = 0.5;
  constexpr double seconds_per_minute = 60.0;
  const double half_difference_mps = measured.turn_radps * track_width_m / 2.0;
  const auto rpm = [](double rim_mps) { return rim_mps / rim_m_per_turn * seconds_per_minute; };
  (void)bus_.send(encode(agilex_tables::motor1_fast, {rpm(measured.forward_mps - half_difference_mps)}));
  (void)bus_.send(encode(agilex_tables::motor2_fast, {rpm(measured.forward_mps + half_difference_mps)}));
}

void SimulatedPeriphery::send_battery() {
  (void)bus_.send(
      encode(agilex_tables::battery_state, {charge_percent, healthy_percent, battery_v_, 0.0, room_degc}));
  (void)bus_.send(encode(agilex_tables::battery_extended, {}));
}

/// The lights, and a remote control with its switches up and its sticks untouched.
void SimulatedPeriphery::send_panel() {
  constexpr double up = 2.0;
  CanFrame state = lights_;
  state.id = agilex_tables::light_state.id;
  state.data.back() = counter_++;
  (void)bus_.send(state);
  (void)bus_.send(encode(agilex_tables::remote_state, {up, up, up, up}));
}

}  // namespace lodestar
