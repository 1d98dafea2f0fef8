#include <algorithm>
#include <array>
#include <utility>

#include "drivers/base/agilex_v2.hpp"
#include "drivers/base/agilex_v2_table.hpp"
#include "drivers/base/base_protocol.hpp"
#include "drivers/base/travel_counter.hpp"

namespace lodestar {
namespace {

// Fault bits: bytes 4 and 5 of the system state as one big-endian number, from each model's user manual. A
// base drives on CAN with its transmitter off, and with a battery that is getting low.
constexpr std::array tracer_bits{
    FaultBit{.bit = 0x0100, .name = "battery under-voltage"},
    FaultBit{.bit = 0x0200, .name = "battery under-voltage warning", .stops = false},
    FaultBit{.bit = 0x0400, .name = "remote control lost", .stops = false}};
constexpr std::array hunter_bits{FaultBit{.bit = 0x0200, .name = "steering encoder"},
                                 FaultBit{.bit = 0x0400, .name = "remote control lost", .stops = false},
                                 FaultBit{.bit = 0x1000, .name = "upper computer lost"},
                                 FaultBit{.bit = 0x4000, .name = "motor driver"},
                                 FaultBit{.bit = 0x0001, .name = "battery under-voltage"},
                                 FaultBit{.bit = 0x0008, .name = "steering driver lost"},
                                 FaultBit{.bit = 0x0010, .name = "rear right driver lost"},
                                 FaultBit{.bit = 0x0020, .name = "rear left driver lost"},
                                 FaultBit{.bit = 0x0040, .name = "motor driver too hot"},
                                 FaultBit{.bit = 0x0080, .name = "motor driver over-current"}};

/// What the values of the control mode mean, from the manuals. The remote control is 2 on a Hunter, and 3 in
/// the vendor's client for all.
std::vector<ControlMode> modes_of(BaseModel model) {
  using enum ControlMode;
  return model == BaseModel::hunter ? std::vector{standby, can, remote, remote}
                                    : std::vector{standby, can, uart, remote};
}

class AgilexProtocol final : public BaseProtocol {
 public:
  AgilexProtocol(BaseModel model, double max_plausible_wheel_mps, std::vector<ControlMode> modes)
      : model_(model),
        modes_(modes.empty() ? modes_of(model) : std::move(modes)),
        travel_(max_plausible_wheel_mps) {}

  HeardFrame decode(const StampedCanFrame& received) override {
    const CanFrame& frame = received.frame;
    HeardFrame heard;
    if (auto state = agilex::decode_system_state(frame)) {
      state->mode = mode_of(frame);
      heard.from_base = true;
      heard.system = state;
      heard.odd = state->vehicle == VehicleState::unknown || state->mode == ControlMode::unknown;
    } else if (const auto velocity = agilex::decode_motion_state(frame)) {
      heard.from_base = true;
      heard.measured = velocity;
    } else if (const auto reading = agilex::decode_odometer(frame)) {
      heard.from_base = true;
      heard.travel = travel_.take(received.stamp, *reading);
      heard.odd = !heard.travel;
    } else {
      heard.odd = frame.id == agilex::system_state_id || frame.id == agilex::motion_state_id ||
                  frame.id == agilex::odometer_id;
      heard.command = frame.id == agilex::motion_command_id;
    }
    return heard;
  }

  [[nodiscard]] std::vector<CanFrame> enable() const override {
    const auto can_mode = std::ranges::find(modes_, ControlMode::can) - modes_.begin();
    return {encode(agilex::tables::control_mode, {static_cast<double>(can_mode)})};
  }
  [[nodiscard]] std::vector<CanFrame> command(const BodyVelocity& velocity) const override {
    return {agilex::encode_motion_command(velocity)};
  }
  [[nodiscard]] std::vector<CanFrame> clear_faults() const override { return {agilex::encode_clear_fault()}; }

  [[nodiscard]] std::vector<std::uint32_t> identifiers() const override {
    return {agilex::motion_command_id, agilex::control_mode_id, agilex::clear_fault_id,
            agilex::system_state_id,   agilex::motion_state_id, agilex::odometer_id};
  }

  [[nodiscard]] std::span<const FaultBit> known_fault_bits() const override {
    if (model_ == BaseModel::hunter) return hunter_bits;
    return tracer_bits;
  }

 private:
  [[nodiscard]] ControlMode mode_of(const CanFrame& system_state) const {
    constexpr std::size_t mode_byte = 1;
    const std::size_t value = system_state.data.at(mode_byte);
    return value < modes_.size() ? modes_[value] : ControlMode::unknown;
  }

  BaseModel model_;
  std::vector<ControlMode> modes_;
  TravelCounter travel_;
};

}  // namespace

std::unique_ptr<BaseProtocol> make_agilex_protocol(BaseModel model, double max_plausible_wheel_mps,
                                                   std::vector<ControlMode> modes) {
  return std::make_unique<AgilexProtocol>(model, max_plausible_wheel_mps, std::move(modes));
}

}  // namespace lodestar
