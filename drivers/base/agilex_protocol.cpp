#include <array>
#include <fmt/format.h>
#include <utility>

#include "drivers/base/agilex_v2.hpp"
#include "drivers/base/base_protocol.hpp"
#include "drivers/base/travel_counter.hpp"

namespace lodestar {
namespace {

struct NamedBit {
  std::uint32_t bit = 0;
  const char* name = "";
};

// Fault bits: bytes 4 and 5 of the system state as one big-endian number, from each model's user manual.
constexpr std::array tracer_bits{NamedBit{0x0100, "battery under-voltage"},
                                 NamedBit{0x0200, "battery under-voltage warning"},
                                 NamedBit{0x0400, "remote control lost"}};
constexpr std::array hunter_bits{
    NamedBit{0x0200, "steering encoder"},       NamedBit{0x0400, "remote control lost"},
    NamedBit{0x1000, "upper computer lost"},    NamedBit{0x4000, "motor driver"},
    NamedBit{0x0001, "battery under-voltage"},  NamedBit{0x0008, "steering driver lost"},
    NamedBit{0x0010, "rear right driver lost"}, NamedBit{0x0020, "rear left driver lost"},
    NamedBit{0x0040, "motor driver too hot"},   NamedBit{0x0080, "motor driver over-current"}};

template <std::size_t count>
std::vector<std::string> names_of(std::uint32_t bits, const std::array<NamedBit, count>& known) {
  std::vector<std::string> names;
  for (const auto& [bit, name] : known) {
    if ((bits & bit) != 0) names.emplace_back(name);
    bits &= ~bit;
  }
  if (bits != 0) names.push_back(fmt::format("unknown fault bits 0x{:04X}", bits));
  return names;
}

class AgilexProtocol final : public BaseProtocol {
 public:
  AgilexProtocol(BaseModel model, double max_plausible_wheel_mps)
      : model_(model), travel_(max_plausible_wheel_mps) {}

  HeardFrame decode(const StampedCanFrame& received) override {
    const CanFrame& frame = received.frame;
    HeardFrame heard;
    if (const auto state = agilex::decode_system_state(frame)) {
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
    return {agilex::encode_control_mode(ControlMode::can)};
  }
  [[nodiscard]] std::vector<CanFrame> command(const BodyVelocity& velocity) const override {
    return {agilex::encode_motion_command(velocity)};
  }
  [[nodiscard]] std::vector<CanFrame> clear_faults() const override { return {agilex::encode_clear_fault()}; }

  [[nodiscard]] std::vector<std::uint32_t> identifiers() const override {
    return {agilex::motion_command_id, agilex::control_mode_id, agilex::clear_fault_id,
            agilex::system_state_id,   agilex::motion_state_id, agilex::odometer_id};
  }

  [[nodiscard]] std::vector<std::string> fault_names(std::uint32_t bits) const override {
    return model_ == BaseModel::hunter ? names_of(bits, hunter_bits) : names_of(bits, tracer_bits);
  }

 private:
  BaseModel model_;
  TravelCounter travel_;
};

}  // namespace

std::unique_ptr<BaseProtocol> make_agilex_protocol(BaseModel model, double max_plausible_wheel_mps) {
  return std::make_unique<AgilexProtocol>(model, max_plausible_wheel_mps);
}

}  // namespace lodestar
