#pragma once

#include <cstdint>
#include <optional>

#include "drivers/simulation/simulated_base.hpp"
#include "maps/footprint.hpp"
#include "maps/geometry.hpp"
#include "maps/occupancy_map.hpp"
#include "maps/random.hpp"

namespace lodestar {

/// Wheels and ground contact: holds the robot's true pose. For the simulated world only; navigation code must
/// not use it.
class SimulatedMotion {
 public:
  /// Obstacles: a robot, a disc or a footprint, against the cells of a map that are not drivable.
  struct Surroundings {
    OccupancyMap map;
    double robot_radius_m = 0.0;
    std::optional<Footprint> footprint;  ///< in place of the disc
  };

  /// Without surroundings the floor is unbounded and empty.
  SimulatedMotion(const SimulatedBaseOptions& options, const Pose2& start, std::uint64_t seed,
                  std::optional<Surroundings> surroundings = std::nullopt);

  /// Speed setpoints of the motors, at the rim of the wheels as configured in the firmware.
  void set_wheel_targets(double left_mps, double right_mps);

  /// Sets the slip: the share of each wheel's travel by which the robot moves less than the wheel rolls; 0:
  /// none.
  void slip(double left_share, double right_share);

  /// Kidnaps the robot: displaces it by `by_m` in a random direction in which it ends up clear of obstacles,
  /// and turns it by `turn_rad`. Does nothing where there is no room.
  void carry_off(double by_m, double turn_rad, Random random);

  /// Integrates the motion over a short time, a millisecond or two, along an exact arc.
  void step(Duration by);

  // Encoder readings: travel since power-up, in whole encoder steps.
  [[nodiscard]] double left_encoder_m() const;
  [[nodiscard]] double right_encoder_m() const;

  /// Displaces the robot by `by` in its own frame without turning the wheels.
  void push(const Pose2& by) { map_from_base_ = map_from_base_ * by; }

  /// Replaces the map of obstacles.
  void change_surroundings(const OccupancyMap& map);

  [[nodiscard]] const Pose2& true_map_from_base() const { return map_from_base_; }

  /// True when an obstacle blocked the last step: the wheels turned, the robot did not move.
  [[nodiscard]] bool is_blocked() const { return blocked_; }

 private:
  struct Wheel {
    double target_mps = 0.0;
    double speed_mps = 0.0;
    double rolled_m = 0.0;
    double slipping_share = 0.0;
  };

  double roll(Wheel& wheel, double scale, double elapsed_s);
  void move(double left_m, double right_m);
  [[nodiscard]] bool overlaps_obstacle(const Pose2& map_from_base) const;
  [[nodiscard]] double encoder_m(const Wheel& wheel) const;

  SimulatedBaseOptions options_;
  std::optional<Surroundings> surroundings_;
  Random slip_;
  Wheel left_;
  Wheel right_;
  Pose2 map_from_base_;
  bool blocked_ = false;
};

}  // namespace lodestar
