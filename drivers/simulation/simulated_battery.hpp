#pragma once

#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// A pack of seven lithium cells in series, and the dock that charges it.
struct SimulatedBatteryOptions {
  double capacity_ah = 10.0;
  double empty_v = 22.0;  ///< at rest; linear in the charge up to full_v
  double full_v = 28.8;
  double start_v = 26.0;  ///< at rest, when the world begins
  double resistance_ohm = 0.08;
  double idle_a = 1.0;      ///< computer, camera and electronics
  double drive_a = 5.0;     ///< more while the motors drive
  double charger_a = 10.0;  ///< constant current up to the end voltage, and constant voltage from there on
  double charger_end_v = 29.2;
  Pose2 map_from_dock;    ///< where the base must stand for its contacts to touch
  double reach_m = 0.03;  ///< contacts give way by so much
  double reach_rad = 0.09;
};

/// Charge and voltage of the robot's battery. Only the simulated world knows where its dock is.
class SimulatedBattery {
 public:
  explicit SimulatedBattery(const SimulatedBatteryOptions& options);

  void step(Duration by, bool drives, const Pose2& true_map_from_base);
  /// At the terminals, under the present load.
  [[nodiscard]] double voltage_v() const { return voltage_v_; }

 private:
  [[nodiscard]] double charging_a(const Pose2& true_map_from_base) const;
  [[nodiscard]] double rest_v() const;

  SimulatedBatteryOptions options_;
  double charge_ = 0.0;  ///< share of the capacity, 0..1
  double voltage_v_ = 0.0;
};

}  // namespace lodestar
