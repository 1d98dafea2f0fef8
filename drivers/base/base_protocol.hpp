#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/base/base_state.hpp"
#include "drivers/can/can_bus.hpp"
#include "maps/motion.hpp"

namespace lodestar {

/// What one frame says, in words that all bases share.
struct HeardFrame {
  bool from_base = false;  ///< one of the base's messages, whole and believable
  bool odd = false;        ///< one of the base's identifiers, but short, not finite, or a leap
  bool command = false;    ///< a motion command: of ourselves no copy is heard, so another master's
  std::optional<SystemState> system;
  std::optional<BodyVelocity> measured;
  std::optional<WheelTravel> travel;  ///< since the first reading
};

/// How to talk to one kind of base: what to send, and what its frames mean. It keeps what must be put
/// together from several frames, and decides nothing.
class BaseProtocol {
 public:
  BaseProtocol() = default;
  BaseProtocol(const BaseProtocol&) = delete;
  BaseProtocol& operator=(const BaseProtocol&) = delete;
  virtual ~BaseProtocol() = default;

  virtual HeardFrame take_in(const StampedCanFrame& received) = 0;

  /// Asks the base to take commands from the bus.
  [[nodiscard]] virtual std::vector<CanFrame> enable() const = 0;
  [[nodiscard]] virtual std::vector<CanFrame> command(const BodyVelocity& velocity) const = 0;
  [[nodiscard]] virtual std::vector<CanFrame> clear_faults() const = 0;
  /// All that is sent or listened to.
  [[nodiscard]] virtual std::vector<std::uint32_t> identifiers() const = 0;
  /// The names of the bits that are set, in words for people.
  [[nodiscard]] virtual std::vector<std::string> fault_names(std::uint32_t bits) const = 0;

  [[nodiscard]] std::vector<CanFrame> stop() const { return command({}); }
};

enum class BaseModel { tracer, scout, hunter };

/// AgileX V2; the fault bits mean something else on each model.
std::unique_ptr<BaseProtocol> make_agilex_protocol(BaseModel model = BaseModel::tracer,
                                                   double max_plausible_wheel_mps = 5.0);

/// Two wheels on the axes of an ODrive.
struct OdriveOptions {
  std::uint32_t left_node = 0;
  std::uint32_t right_node = 1;
  bool right_is_mirrored = true;  ///< turns backwards to drive ahead
  double track_width_m = 0.40;
  double wheel_diameter_m = 0.17;
  double max_plausible_wheel_mps = 5.0;
};

/// ODrive CANSimple, firmware 0.6.
std::unique_ptr<BaseProtocol> make_odrive_protocol(const OdriveOptions& options);

}  // namespace lodestar
