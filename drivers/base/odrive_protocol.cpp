#include <array>
#include <numbers>

#include "drivers/base/base_protocol.hpp"
#include "drivers/base/odrive_table.hpp"
#include "drivers/base/travel_counter.hpp"

namespace lodestar {
namespace {

namespace odrive_tables = odrive::tables;

/// The subset of CANSimple that the driver sends or needs to receive.
constexpr std::array spoken{odrive_tables::heartbeat,          odrive_tables::encoder_estimates,
                            odrive_tables::set_axis_state,     odrive_tables::set_controller_mode,
                            odrive_tables::set_input_velocity, odrive_tables::clear_errors};

/// Readings of the two axes are combined only when they are about equally old.
constexpr Duration most_apart = std::chrono::milliseconds(300);
constexpr Duration most_apart_moving = std::chrono::milliseconds(40);

constexpr std::array error_bits{FaultBit{.bit = 0x1, .name = "initializing"},
                                FaultBit{.bit = 0x2, .name = "system level"},
                                FaultBit{.bit = 0x4, .name = "timing"},
                                FaultBit{.bit = 0x8, .name = "missing estimate"},
                                FaultBit{.bit = 0x10, .name = "bad configuration"},
                                FaultBit{.bit = 0x20, .name = "gate driver"},
                                FaultBit{.bit = 0x40, .name = "missing input"},
                                FaultBit{.bit = 0x100, .name = "over-voltage"},
                                FaultBit{.bit = 0x200, .name = "under-voltage"},
                                FaultBit{.bit = 0x400, .name = "over-current"},
                                FaultBit{.bit = 0x800, .name = "too much regenerated"},
                                FaultBit{.bit = 0x1000, .name = "current limit"},
                                FaultBit{.bit = 0x2000, .name = "motor too hot"},
                                FaultBit{.bit = 0x4000, .name = "inverter too hot"},
                                FaultBit{.bit = 0x8000, .name = "velocity limit"},
                                FaultBit{.bit = 0x10000, .name = "position limit"},
                                FaultBit{.bit = odrive::watchdog_expired, .name = "watchdog expired"},
                                FaultBit{.bit = odrive::estop_requested, .name = "emergency stop requested"},
                                FaultBit{.bit = 0x04000000, .name = "spinout"},
                                FaultBit{.bit = 0x08000000, .name = "brake resistor"},
                                FaultBit{.bit = 0x10000000, .name = "thermistor"},
                                FaultBit{.bit = 0x40000000, .name = "calibration"}};

/// The newest values of one axis.
struct Axis {
  std::optional<Stamp> heartbeat;
  std::uint32_t errors = 0;
  std::uint8_t state = 0;
  std::optional<Stamp> estimate;
  double position_rev = 0.0;
  double velocity_rps = 0.0;
};

class OdriveProtocol final : public BaseProtocol {
 public:
  explicit OdriveProtocol(const OdriveOptions& options)
      : options_(options), travel_(options.max_plausible_wheel_mps) {}

  HeardFrame decode(const StampedCanFrame& received) override {
    HeardFrame heard;
    for (const bool is_right : {false, true}) {
      const std::uint32_t offset = offset_of(is_right);
      const CanFrame& frame = received.frame;
      Axis& axis = is_right ? right_ : left_;
      if (const auto heartbeat = lodestar::decode(odrive_tables::heartbeat, frame, offset)) {
        axis.heartbeat = received.stamp;
        axis.errors = static_cast<std::uint32_t>((*heartbeat)[0]);
        axis.state = static_cast<std::uint8_t>((*heartbeat)[1]);
        heard.from_base = true;
        heard.system = system_state(received.stamp);
      } else if (const auto estimate = lodestar::decode(odrive_tables::encoder_estimates, frame, offset)) {
        axis.estimate = received.stamp;
        axis.position_rev = (*estimate)[0];
        axis.velocity_rps = (*estimate)[1];
        heard.from_base = true;
        if (is_right) decode_wheels(received.stamp, heard);
      } else {
        heard.odd = heard.odd || frame.id == odrive_tables::heartbeat.id + offset ||
                    frame.id == odrive_tables::encoder_estimates.id + offset;
        heard.command = heard.command || frame.id == odrive_tables::set_input_velocity.id + offset;
      }
    }
    return heard;
  }

  [[nodiscard]] std::vector<CanFrame> enable() const override {
    std::vector<CanFrame> frames;
    for (const std::uint32_t offset : {offset_of(false), offset_of(true)}) {
      frames.push_back(encode(odrive_tables::set_controller_mode,
                              {odrive::velocity_control, odrive::passthrough}, offset));
      frames.push_back(encode(odrive_tables::set_input_velocity, {}, offset));
      frames.push_back(encode(odrive_tables::set_axis_state, {odrive::closed_loop_control}, offset));
    }
    return frames;
  }

  [[nodiscard]] std::vector<CanFrame> command(const BodyVelocity& velocity) const override {
    const double half_difference_mps = velocity.turn_radps * options_.track_width_m / 2.0;
    const double left_rps = (velocity.forward_mps - half_difference_mps) / m_per_rev();
    const double right_rps = (velocity.forward_mps + half_difference_mps) / m_per_rev();
    return {encode(odrive_tables::set_input_velocity, {left_rps}, offset_of(false)),
            encode(odrive_tables::set_input_velocity, {right_sign() * right_rps + 0.0}, offset_of(true))};
  }

  [[nodiscard]] std::vector<CanFrame> clear_faults() const override {
    return {encode(odrive_tables::clear_errors, {}, offset_of(false)),
            encode(odrive_tables::clear_errors, {}, offset_of(true))};
  }

  [[nodiscard]] std::vector<std::uint32_t> identifiers() const override {
    std::vector<std::uint32_t> all;
    for (const std::uint32_t offset : {offset_of(false), offset_of(true)}) {
      for (const MessageSpec& message : spoken) all.push_back(message.id + offset);
    }
    return all;
  }

  [[nodiscard]] std::span<const FaultBit> known_fault_bits() const override { return error_bits; }

 private:
  [[nodiscard]] std::uint32_t offset_of(bool is_right) const {
    return odrive::node_step * (is_right ? options_.right_node : options_.left_node);
  }
  [[nodiscard]] double m_per_rev() const { return std::numbers::pi * options_.wheel_diameter_m; }
  [[nodiscard]] double right_sign() const { return options_.right_is_mirrored ? -1.0 : 1.0; }

  /// Empty until both axes have sent a heartbeat: a base needs both wheels.
  std::optional<SystemState> system_state(Stamp now) {
    for (const Axis* axis : {&left_, &right_}) {
      if (!axis->heartbeat || now - *axis->heartbeat > most_apart) return std::nullopt;
    }
    SystemState state;
    state.fault_bits = left_.errors | right_.errors;
    if ((state.fault_bits & odrive::estop_requested) != 0) state.vehicle = VehicleState::emergency_stop;
    const bool both_in_control =
        left_.state == odrive::closed_loop_control && right_.state == odrive::closed_loop_control;
    state.mode = both_in_control ? ControlMode::can : ControlMode::standby;
    state.counter = ++pulses_;
    return state;
  }

  /// Completes the pair: the right axis sends after the left one.
  void decode_wheels(Stamp now, HeardFrame& heard) {
    if (!left_.estimate || now - *left_.estimate > most_apart_moving) return;
    const double left_mps = left_.velocity_rps * m_per_rev();
    const double right_mps = right_sign() * right_.velocity_rps * m_per_rev();
    heard.measured =
        BodyVelocity{(left_mps + right_mps) / 2.0, (right_mps - left_mps) / options_.track_width_m};
    heard.travel = travel_.take(now, left_.position_rev * m_per_rev() * mm_per_m,
                                right_sign() * right_.position_rev * m_per_rev() * mm_per_m);
    heard.odd = !heard.travel;
  }

  OdriveOptions options_;
  Axis left_;
  Axis right_;
  std::uint8_t pulses_ = 0;
  TravelCounter travel_;
};

}  // namespace

std::unique_ptr<BaseProtocol> make_odrive_protocol(const OdriveOptions& options) {
  return std::make_unique<OdriveProtocol>(options);
}

}  // namespace lodestar
