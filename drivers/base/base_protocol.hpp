#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/base/base_state.hpp"
#include "drivers/can/can_bus.hpp"
#include "maps/motion.hpp"

namespace lodestar {

/// The content of one frame, independent of the protocol.
struct HeardFrame {
  bool from_base = false;  ///< a complete and plausible message of the base
  bool odd = false;        ///< one of the base's identifiers, but too short, not finite, or an odometer jump
  bool command = false;    ///< a motion command of another master (our own frames are not received)
  std::optional<SystemState> system;
  std::optional<BodyVelocity> measured;
  std::optional<WheelTravel> travel;  ///< since the first reading
};

/// A bit of SystemState::fault_bits.
struct FaultBit {
  std::uint32_t bit = 0;
  std::string_view name;
  bool stops = true;  ///< false: a warning, which the base drives with
};

/// Protocol of one kind of base: what to send, and what its frames mean. It keeps state only to assemble
/// values from several frames, and makes no decisions.
class BaseProtocol {
 public:
  BaseProtocol() = default;
  BaseProtocol(const BaseProtocol&) = delete;
  BaseProtocol& operator=(const BaseProtocol&) = delete;
  virtual ~BaseProtocol() = default;

  virtual HeardFrame decode(const StampedCanFrame& received) = 0;

  /// Requests that the base accepts commands from the bus.
  [[nodiscard]] virtual std::vector<CanFrame> enable() const = 0;
  [[nodiscard]] virtual std::vector<CanFrame> command(const BodyVelocity& velocity) const = 0;
  [[nodiscard]] virtual std::vector<CanFrame> clear_faults() const = 0;
  /// All identifiers that are sent or received.
  [[nodiscard]] virtual std::vector<std::uint32_t> identifiers() const = 0;
  /// The fault bits that the model defines; any other is a fault.
  [[nodiscard]] virtual std::span<const FaultBit> known_fault_bits() const = 0;

  /// Descriptions of the bits that are set, for messages.
  [[nodiscard]] std::vector<std::string> fault_names(std::uint32_t bits) const;
  /// The bits that are only warnings.
  [[nodiscard]] std::uint32_t warning_bits() const;
  [[nodiscard]] std::vector<CanFrame> stop() const { return command({}); }
};

enum class BaseModel { tracer, scout, hunter };

/// AgileX V2; the meaning of the fault bits and of the control mode depends on the model. `modes`: what the
/// values 0, 1, ... of the control mode mean, where the firmware differs from the model's manual; it must
/// contain ControlMode::can, and a value beyond it is ControlMode::unknown. Empty: as in the manual.
std::unique_ptr<BaseProtocol> make_agilex_protocol(BaseModel model = BaseModel::tracer,
                                                   double max_plausible_wheel_mps = 5.0,
                                                   std::vector<ControlMode> modes = {});

/// Two wheels on the axes of an ODrive.
struct OdriveOptions {
  std::uint32_t left_node = 0;
  std::uint32_t right_node = 1;
  bool right_is_mirrored = true;  ///< turns backwards when the robot drives forward
  double track_width_m = 0.40;
  double wheel_diameter_m = 0.17;
  double max_plausible_wheel_mps = 5.0;
};

/// ODrive CANSimple, firmware 0.6.
std::unique_ptr<BaseProtocol> make_odrive_protocol(const OdriveOptions& options);

}  // namespace lodestar
