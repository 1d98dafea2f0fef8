#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/base/agilex_v2.hpp"
#include "drivers/base/base_protocol.hpp"
#include "drivers/base/command_following.hpp"
#include "drivers/can/can_bus.hpp"
#include "maps/motion.hpp"

namespace lodestar {

struct BaseDriverOptions {
  double max_forward_mps = 1.0;  ///< commands beyond are saturated, and counted
  double max_turn_radps = 2.0;
  double max_wheel_mps = std::numeric_limits<double>::infinity();  ///< of either wheel, on this track
  double track_width_m = 0.40;
  /// Interval at which CAN mode is requested until it is granted.
  Duration handshake_period = std::chrono::milliseconds(100);
  Duration max_feedback_age = std::chrono::milliseconds(100);  ///< age of the newest frame of any kind
  /// Age of the newest system state, motion state and odometer frame, each on its own.
  Duration max_kind_age = std::chrono::milliseconds(300);
  Duration base_command_timeout = std::chrono::milliseconds(500);  ///< after which the base stops by itself
  /// Bits that do not stop this base, besides those that are only warnings by the protocol's own table.
  std::uint32_t ignored_fault_bits = 0;
  int max_failed_sends = 3;          ///< consecutive
  double error_passive_share = 0.3;  ///< factor on the speed limits while the bus is error-passive
  CommandFollowingOptions following{};
};

enum class BaseState {
  waiting_for_base,     ///< silent, or not fit to drive: see BaseFeedback::fault
  asking_for_can_mode,  ///< feedback received, CAN mode requested
  ready,                ///< accepts commands
  fault                 ///< latched until resume()
};

/// Why the base cannot be driven.
enum class BaseFault {
  feedback_lost,        ///< the base is silent
  feedback_incomplete,  ///< the base sends, but not its state, its motion or its odometer
  counter_stuck,        ///< the base repeats its state: the counter in it does not advance
  left_can_mode,        ///< another controller has taken over, such as the remote control
  emergency_stop,       ///< pressed on the base
  vehicle_exception,    ///< reported by the base, or an unknown state
  fault_bits,           ///< a bit is set that is neither a warning nor in ignored_fault_bits
  not_following,        ///< measured motion deviates from the command
  second_master,        ///< another node sends motion commands on the bus
  send_failed,          ///< several consecutive commands could not be sent
  bus_stalled,          ///< the bus no longer accepts frames
  bus_off,              ///< the CAN controller has left the bus
  bus_down,             ///< the CAN interface is switched off
  bus_missing,          ///< the CAN interface does not exist
  guard_stopped,        ///< the guard stopped the base because the navigator hung
  guard_lost            ///< the guard process has ended; it is not restarted
};

// Descriptions for messages.
std::string_view to_string(BaseState state);
std::string_view to_string(BaseFault fault);
/// True for a fault that the base itself reports: it may have latched it, and can be asked to clear it.
bool is_reported_by_base(BaseFault fault);
/// The fault, and its details unless they are empty: "the base reports fault bits: battery under-voltage".
std::string in_words(BaseFault fault, const std::string& details);

/// What the base reported since the last poll, and its present state.
struct BaseFeedback {
  BaseState state = BaseState::waiting_for_base;
  std::optional<BaseFault> fault;        ///< in state fault: the first cause; before ready: what is missing
  std::string details;                   ///< of `fault`, in words: names of fault bits, what it does not send
  std::vector<WheelTravel> travel;       ///< new odometer readings, oldest first, unwrapped
  std::optional<BodyVelocity> measured;  ///< from the newest motion state received
  std::optional<SystemState> system;     ///< the newest system state received
  std::optional<Stamp> last_heard;       ///< arrival of the newest valid frame from the base
};

/// Irregularities since the start that did not stop the robot.
struct BaseDriverCounts {
  std::uint64_t saturated_commands = 0;
  std::uint64_t non_finite_commands = 0;
  std::uint64_t failed_sends = 0;
  std::uint64_t odd_frames = 0;  ///< from the base, but too short, with an unknown state or an odometer jump
  std::uint64_t counter_jumps = 0;    ///< system states missing or out of order
  std::uint64_t counter_repeats = 0;  ///< system states whose counter did not advance
};

/// Drives a base and monitors its feedback. A successful send proves nothing; only feedback frames count. Any
/// fault of a ready base is latched: the robot does not move again until resume(), and the driver does not
/// contend for a base that another controller has taken over.
class BaseDriver {
 public:
  /// A TRACER.
  explicit BaseDriver(CanBus& bus, const BaseDriverOptions& options = {});
  BaseDriver(CanBus& bus, std::unique_ptr<BaseProtocol> protocol, const BaseDriverOptions& options = {});

  /// Reads all frames that have arrived and continues the handshake. `now` is on the clock of the bus's
  /// stamps.
  BaseFeedback poll(Stamp now);

  /// Sends one motion command if the base is ready, otherwise nothing. Beyond the limits, forward and turn
  /// rates are scaled down together, which keeps the curvature. A velocity that is not finite is sent as zero
  /// and counted.
  void command(const BodyVelocity& velocity);

  /// Clears the latched fault and starts a new handshake. Returns false and changes nothing while the cause
  /// persists: a base must not start to move merely because its emergency stop is released. A base that
  /// latches its own faults is asked to clear them; the next resume() may then succeed.
  ///
  /// Before the base was ever ready: asks a base that reports a fault to clear it, and returns true; the
  /// handshake goes on when it has. Returns false when the driver waits for something else.
  [[nodiscard]] bool resume(Stamp now);

  [[nodiscard]] BaseState state() const { return state_; }
  /// Names of the bits that the base reports and that do not stop it; empty for none.
  [[nodiscard]] std::vector<std::string> warnings() const;
  [[nodiscard]] const BaseDriverCounts& counts() const { return counts_; }
  [[nodiscard]] std::uint64_t saturated_commands() const { return counts_.saturated_commands; }

 private:
  void handle(const StampedCanFrame& received, std::vector<WheelTravel>& travel);
  void update_system_state(Stamp stamp, const SystemState& state);
  void watch(Stamp now);
  void shake_hands(Stamp now);
  void latch(BaseFault fault);
  void set_fault(const std::optional<BaseFault>& fault);
  bool send(const std::vector<CanFrame>& frames);
  [[nodiscard]] std::optional<BaseFault> state_fault(Stamp now) const;
  [[nodiscard]] std::optional<BaseFault> feedback_fault(Stamp now) const;
  [[nodiscard]] std::string details_of(BaseFault fault) const;
  [[nodiscard]] std::uint32_t stopping_bits(const SystemState& state) const;
  [[nodiscard]] std::optional<BaseFault> system_fault(const SystemState& state) const;
  [[nodiscard]] std::optional<BaseFault> bus_fault() const;
  [[nodiscard]] BodyVelocity within_limits(const BodyVelocity& velocity);

  CanBus& bus_;
  std::unique_ptr<BaseProtocol> protocol_;
  BaseDriverOptions options_;
  BaseState state_ = BaseState::waiting_for_base;
  std::optional<BaseFault> fault_;
  std::string details_;  ///< of the fault
  BaseDriverCounts counts_;
  int failed_sends_in_a_row_ = 0;
  Stamp now_;
  std::optional<Stamp> asked_at_;  ///< last request for CAN mode

  std::optional<Stamp> last_heard_;
  std::optional<Stamp> heard_since_;  ///< without a silence of max_feedback_age
  std::optional<Stamp> last_state_;
  std::optional<Stamp> last_alive_;  ///< newest system state whose counter had advanced
  bool counter_has_advanced_ = false;
  std::optional<Stamp>
      incomplete_at_;  ///< when a kind of feedback last was missing before the base was ready
  std::optional<Stamp> last_motion_state_;
  std::optional<Stamp> last_odometer_;
  std::optional<SystemState> system_;
  std::optional<BodyVelocity> measured_;

  BodyVelocity commanded_;  ///< last velocity sent
  std::optional<Stamp> commanded_at_;
  CommandFollowing following_;
};

}  // namespace lodestar
