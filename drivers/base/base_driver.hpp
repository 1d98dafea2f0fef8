#pragma once

#include <cstdint>
#include <memory>
#include <optional>
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
  Duration handshake_period =
      std::chrono::milliseconds(100);  ///< how often CAN mode is asked for until granted
  Duration max_feedback_age = std::chrono::milliseconds(100);  ///< of the newest frame of any kind
  Duration max_kind_age =
      std::chrono::milliseconds(300);  ///< of system state, motion state and odometer, each for itself
  Duration base_command_timeout = std::chrono::milliseconds(500);  ///< after which the base stops by itself
  std::uint32_t ignored_fault_bits = 0;  ///< that may be set on this model without being a fault
  int max_failed_sends = 3;              ///< in a row
  double error_passive_share = 0.3;      ///< of the speed limits, while frames are damaged on the wire
  CommandFollowingOptions following{};
};

enum class BaseState {
  waiting_for_base,     ///< silent, or not fit to drive: BaseFeedback::fault tells
  asking_for_can_mode,  ///< heard, and asked to take commands from the bus
  ready,                ///< takes commands
  fault                 ///< latched until resume()
};

/// Why the base cannot be driven.
enum class BaseFault {
  feedback_lost,      ///< the base is silent, or repeats itself
  left_can_mode,      ///< somebody else drives: the remote control has been handed the base
  emergency_stop,     ///< pressed on the base
  vehicle_exception,  ///< the base says so, or says something unknown
  fault_bits,         ///< a bit set that is not on the list of the ignored
  not_following,      ///< moves otherwise than commanded
  second_master,      ///< somebody else sends motion commands on the bus
  send_failed,        ///< several commands in a row could not be handed over
  bus_stalled,        ///< the bus takes no frames any more
  bus_off,            ///< the CAN controller has left the bus
  bus_down,           ///< the CAN interface is switched off
  bus_missing,        ///< the CAN interface is not there
  guard_stopped,      ///< the navigator had hung
  guard_lost          ///< the guard process is gone; nothing brings it back
};

// In words for people.
std::string_view to_string(BaseState state);
std::string_view to_string(BaseFault fault);

/// What the base said since the last poll, and how it stands.
struct BaseFeedback {
  BaseState state = BaseState::waiting_for_base;
  std::optional<BaseFault> fault;        ///< in state fault: the first cause. Before ready: what is missing.
  std::vector<WheelTravel> travel;       ///< new odometer readings, oldest first, unwrapped
  std::optional<BodyVelocity> measured;  ///< the newest motion state ever heard
  std::optional<SystemState> system;     ///< the newest ever heard
  std::optional<Stamp> last_heard;       ///< of the newest valid frame from the base
};

/// What went wrong without stopping the robot, since the start.
struct BaseDriverCounts {
  std::uint64_t saturated_commands = 0;
  std::uint64_t non_finite_commands = 0;
  std::uint64_t failed_sends = 0;
  std::uint64_t odd_frames = 0;       ///< of the base, but short, with an unknown state or an odometer leap
  std::uint64_t counter_jumps = 0;    ///< system states that are missing or out of order
  std::uint64_t counter_repeats = 0;  ///< system states whose counter stood still
};

/// The navigator's side of a base. It knows the base by CAN frames only: that a frame could be
/// sent proves nothing. Any cause that takes a ready base away is latched; the robot does not move again
/// until somebody says resume(), and the driver does not fight for a base that was taken over.
class BaseDriver {
 public:
  /// An AgileX V2 base.
  explicit BaseDriver(CanBus& bus, const BaseDriverOptions& options = {});
  BaseDriver(CanBus& bus, std::unique_ptr<BaseProtocol> protocol, const BaseDriverOptions& options = {});

  /// Takes in all frames that have arrived, and carries on the handshake. `now` is on the clock of the bus's
  /// stamps.
  BaseFeedback poll(Stamp now);

  /// Sends one motion command, if the base is ready; otherwise sends nothing. Beyond the limits, forward and
  /// turn are scaled down together, so that the curve is kept. A velocity that is not finite is sent as zero
  /// and counted.
  void command(const BodyVelocity& velocity);

  /// Leaves the latched fault for a new handshake. False, and nothing changes, while the cause is still
  /// there: a base must not start to move because somebody releases its emergency stop. A base that keeps its
  /// own faults is asked to clear them; then the next resume() may succeed.
  [[nodiscard]] bool resume(Stamp now);

  [[nodiscard]] const BaseDriverCounts& counts() const { return counts_; }
  [[nodiscard]] std::uint64_t saturated_commands() const { return counts_.saturated_commands; }

 private:
  void take_in(const StampedCanFrame& received, std::vector<WheelTravel>& travel);
  void take_in_system_state(Stamp stamp, const SystemState& state);
  void watch(Stamp now);
  void shake_hands(Stamp now);
  void latch(BaseFault fault);
  bool send(const std::vector<CanFrame>& frames);
  [[nodiscard]] bool hears_state(Stamp now) const;
  [[nodiscard]] bool hears_everything(Stamp now) const;
  [[nodiscard]] std::optional<BaseFault> complaint(const SystemState& state) const;
  [[nodiscard]] std::optional<BaseFault> complaint_of_bus() const;
  [[nodiscard]] BodyVelocity within_limits(const BodyVelocity& velocity);

  CanBus& bus_;
  std::unique_ptr<BaseProtocol> protocol_;
  BaseDriverOptions options_;
  BaseState state_ = BaseState::waiting_for_base;
  std::optional<BaseFault> fault_;
  BaseDriverCounts counts_;
  int failed_sends_in_a_row_ = 0;
  Stamp now_;
  std::optional<Stamp> asked_at_;  ///< for CAN mode

  std::optional<Stamp> last_heard_;
  std::optional<Stamp> last_alive_;  ///< newest system state whose counter had moved
  std::optional<Stamp> last_motion_state_;
  std::optional<Stamp> last_odometer_;
  std::optional<SystemState> system_;
  std::optional<BodyVelocity> measured_;

  BodyVelocity commanded_;  ///< as sent
  std::optional<Stamp> commanded_at_;
  CommandFollowing following_;
};

}  // namespace lodestar
