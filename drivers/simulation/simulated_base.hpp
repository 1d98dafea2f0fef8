#pragma once

#include <cstdint>
#include <optional>

#include "drivers/base/agilex_v2.hpp"
#include "drivers/can/can_bus.hpp"
#include "drivers/simulation/simulated_firmware.hpp"
#include "drivers/simulation/simulated_periphery.hpp"
#include "maps/motion.hpp"

namespace lodestar {

/// True parameters of a differential base.
struct SimulatedBaseOptions {
  double track_width_m = 0.40;  ///< as configured in the firmware
  double true_track_width_m = 0.404;
  double left_wheel_scale = 1.006;  ///< true travel over reported travel: unequal wheels
  double right_wheel_scale = 0.994;
  /// Random error of each wheel's travel over ground, per square root of metre rolled.
  double slip_sigma_per_sqrt_m = 0.002;
  double motor_lag_s = 0.08;  ///< first-order lag of the wheel speed loop
  double max_wheel_acceleration_mps2 = 2.0;
  // Limits of the motors, and of the firmware (assumed); commands beyond them keep their curvature.
  double max_wheel_mps = 1.6;
  double max_forward_mps = 1.6;
  double max_turn_radps = 2.0;
  double encoder_step_m = 0.0005;      ///< quantization of the wheel encoders
  double speed_filter_s = 0.03;        ///< smoothing of the measured speed in the motion state
  std::int32_t odometer_start_mm = 0;  ///< initial value of both counters
  double battery_v = 26.0;
  Duration command_timeout = std::chrono::milliseconds(500);
  Duration feedback_period = std::chrono::milliseconds(20);
  Duration can_latency = std::chrono::milliseconds(1);
  bool has_periphery = false;  ///< lights, battery ...: for other clients; our driver does not need them
};

class SimulatedMotion;

/// The firmware of an AgileX V2 base on the simulated wheels. It reads the encoders and drives the motors;
/// like real firmware it has no access to the robot's pose. After power-up it is in standby until CAN mode is
/// requested; without motion commands it stops.
class SimulatedBase final : public SimulatedFirmware {
 public:
  SimulatedBase(CanBus& bus, SimulatedMotion& motion, const SimulatedBaseOptions& options = {});

  void step(Stamp now) override;
  void press_emergency_stop(bool pressed) override;
  void take_over_by_remote(bool taken) override;
  void set_fault_bits(std::uint16_t bits) override;
  [[nodiscard]] bool is_told_to_move() const override;
  /// What its sensor at the battery measures from now on.
  void set_battery_v(double battery_v);

 private:
  void handle(const CanFrame& frame, Stamp now);
  void drive_wheels(Stamp now);
  void send_feedback();
  [[nodiscard]] agilex::VehicleState vehicle_state() const;
  [[nodiscard]] bool takes_commands() const;
  [[nodiscard]] BodyVelocity wanted_velocity(Stamp now) const;
  void measure_speed(Stamp now);

  struct Command {
    Stamp stamp;
    BodyVelocity velocity;
  };

  CanBus& bus_;
  SimulatedMotion& motion_;
  SimulatedBaseOptions options_;
  agilex::ControlMode mode_ = agilex::ControlMode::standby;
  bool emergency_stop_ = false;
  std::uint16_t fault_bits_ = 0;
  std::uint8_t counter_ = 0;
  std::optional<Command> command_;
  std::optional<Stamp> next_feedback_;
  SimulatedPeriphery periphery_;
  double last_left_m_ = 0.0;
  double last_right_m_ = 0.0;
  std::optional<Stamp> measured_at_;
  BodyVelocity measured_;
};

}  // namespace lodestar
