#pragma once

#include <cstdint>
#include <optional>

#include "drivers/simulation/simulated_base.hpp"
#include "maps/geometry.hpp"
#include "maps/occupancy_map.hpp"
#include "maps/random.hpp"

namespace lodestar {

/// The wheels and the ground: the only place where the robot truly is somewhere. For the simulated world
/// alone; nothing that navigates may see it.
class SimulatedMotion {
 public:
  /// What the robot can run into: a disc among the cells of a map that are not drivable.
  struct Surroundings {
    OccupancyMap map;
    double robot_radius_m = 0.0;
  };

  /// Without surroundings the floor is endless and empty.
  SimulatedMotion(const SimulatedBaseOptions& options, const Pose2& start, std::uint64_t seed,
                  std::optional<Surroundings> surroundings = std::nullopt);

  /// What the motors are told: speeds at the rim, as the firmware believes the wheels to be.
  void set_wheel_targets(double left_mps, double right_mps);

  /// From now on the floor goes by less than the wheels roll, by these shares; 0: as usual.
  void slip(double left_share, double right_share);

  /// Somebody carries the robot so far, in one of the directions where it then stands free, and turns it by
  /// so much; nobody does where there is no room.
  void carry_off(double by_m, double turn_rad, Random random);

  /// Rolls on for a short time, a millisecond or two, on an exact arc.
  void step(Duration by);

  // What the encoders show: rolled since power-up, in whole encoder steps.
  [[nodiscard]] double left_encoder_m() const;
  [[nodiscard]] double right_encoder_m() const;

  /// Somebody pushes the robot, wheels and all: `by` in its own frame.
  void push(const Pose2& by) { map_from_base_ = map_from_base_ * by; }

  /// What stands around is another one from now on.
  void change_surroundings(const OccupancyMap& map);

  [[nodiscard]] const Pose2& true_map_from_base() const { return map_from_base_; }

  /// The last step ran against an obstacle: the wheels turned, the robot stayed where it was.
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
  [[nodiscard]] bool overlaps_obstacle(const Vec2& position_m) const;
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
