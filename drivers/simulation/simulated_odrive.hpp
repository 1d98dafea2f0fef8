#pragma once

#include <array>
#include <deque>
#include <optional>

#include "drivers/can/can_bus.hpp"
#include "drivers/simulation/simulated_base.hpp"
#include "drivers/simulation/simulated_firmware.hpp"

namespace lodestar {

struct SimulatedOdriveOptions {
  double wheel_diameter_m = 0.17;
  double max_wheel_mps = 1.6;
  double supply_v = 24.0;
  std::uint64_t serial =
      0x3663'3651'3030;  ///< of the drive, 48 bits, in each axis's answer to an enumeration
  bool right_is_mirrored = true;
  Duration heartbeat_period = std::chrono::milliseconds(100);  ///< also of errors, currents, temperatures ...
  Duration estimate_period = std::chrono::milliseconds(10);
  /// Off by default on an ODrive: it then keeps executing the last command.
  std::optional<Duration> watchdog;
};

class SimulatedMotion;

/// An ODrive with two axes (node 0 left, node 1 right) that speaks CANSimple, in velocity control. It sends
/// every message that can be cyclic, and answers requests (a frame without data, or a remote request).
class SimulatedOdrive final : public SimulatedFirmware {
 public:
  SimulatedOdrive(CanBus& bus, SimulatedMotion& motion, const SimulatedOdriveOptions& options = {});

  void step(Stamp now) override;
  void press_emergency_stop(bool pressed) override;
  /// Another device brings the axes to rest.
  void take_over_by_remote(bool taken) override;
  void set_fault_bits(std::uint16_t bits) override;
  [[nodiscard]] bool is_told_to_move() const override;

 private:
  struct Axis {
    std::uint8_t state = 1;
    bool controls_velocity = true;  ///< other control modes are not simulated: the wheel stands
    std::uint32_t errors = 0;
    std::uint32_t disarm_reason = 0;
    double wanted_rps = 0.0;
    std::optional<Stamp> fed;  ///< when the watchdog was last fed
    double last_m = 0.0;
    double speed_rps = 0.0;     ///< positive forward
    double position_rev = 0.0;  ///< of the axis itself: a mirrored one turns backwards
    double velocity_rps = 0.0;
  };

  void handle(const CanFrame& frame, Stamp now);
  void watch(Axis& axis, Stamp now) const;
  void drive_wheels();
  void send_estimates(Stamp now);
  void send_heartbeats();
  void send_health();
  void answer(std::uint32_t node, std::uint32_t command);
  [[nodiscard]] std::optional<CanFrame> frame_of(std::uint32_t node, std::uint32_t command) const;
  void disarm(std::uint32_t error);
  [[nodiscard]] double m_per_rev() const;

  CanBus& bus_;
  SimulatedMotion& motion_;
  SimulatedOdriveOptions options_;
  std::array<Axis, 2> axes_;
  std::deque<CanFrame> answers_;  ///< one is sent per cycle
  bool emergency_stop_ = false;
  std::optional<Stamp> next_estimate_;
  std::optional<Stamp> estimated_at_;
  std::optional<Stamp> next_heartbeat_;
};

}  // namespace lodestar
