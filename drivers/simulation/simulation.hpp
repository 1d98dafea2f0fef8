#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "drivers/camera/camera.hpp"
#include "drivers/camera/depth_camera.hpp"
#include "drivers/can/can_bus.hpp"
#include "drivers/scanner/scanner.hpp"
#include "drivers/simulation/contact_judge.hpp"
#include "drivers/simulation/fault.hpp"
#include "drivers/simulation/moving_disc.hpp"
#include "drivers/simulation/scoring.hpp"
#include "drivers/simulation/simulated_base.hpp"
#include "drivers/simulation/simulated_battery.hpp"
#include "drivers/simulation/simulated_camera_options.hpp"
#include "drivers/simulation/simulated_depth_camera.hpp"
#include "drivers/simulation/simulated_disk.hpp"
#include "drivers/simulation/simulated_scanner.hpp"
#include "drivers/simulation/sliding_door.hpp"
#include "drivers/simulation/walkers.hpp"
#include "maps/camera_model.hpp"
#include "maps/footprint.hpp"
#include "maps/marker_registry.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

/// Everything that makes up the simulated world. Map and registry are the true ones.
struct SimulationOptions {
  SimulatedBaseOptions base;
  SimulatedCameraOptions camera;
  Pose2 start;                               ///< true pose of the base at time 0
  double robot_radius_m = 0.25;              ///< of the disc that collides with obstacles
  std::optional<Footprint> robot_footprint;  ///< collides in place of the disc
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();
  Duration physics_step = std::chrono::milliseconds(1);
  Duration scoring_period = std::chrono::milliseconds(20);  ///< between records of the true pose
  std::uint64_t seed = 1;
  std::vector<Fault> faults;
  std::shared_ptr<SimulatedDisk> disk;             ///< disk of the recorders, if there are any
  std::optional<SimulatedBatteryOptions> battery;  ///< without them its voltage stays as it is
  /// Of the robot's scanner; without them it has none.
  std::optional<SimulatedScannerOptions> scanner;
  /// Of the robot's depth camera; likewise.
  std::optional<SimulatedDepthCameraOptions> depth_camera;
  std::vector<Overhang> overhangs;  ///< not on any map; people walk around them
  double robot_height_m = 1.2;      ///< what hangs lower is in its way
  PeopleOptions people;             ///< besides the discs; they walk about on the true map
  std::vector<MovingDisc> discs;    ///< not on any map; they do not block the robot
  std::vector<SlidingDoor> doors;   ///< likewise
  std::vector<DiscState> others;    ///< moved from outside, such as other robots; as they are at the start
  /// What the judge goes by; the scanner's place, range and times are taken from `scanner` if there is one.
  ContactJudgeOptions contacts;
};

/// The simulated world as a set of drivers: a camera and a CAN bus, advanced in simulated time. It does not
/// expose the robot's true pose; only the Scorer sees it.
class Simulation {
 public:
  /// Throws InputError when the physics step is not positive or the camera's options are not possible.
  Simulation(const OccupancyMap& map, const MarkerRegistry& registry, const CameraModel& camera,
             const SimulationOptions& options);
  ~Simulation();

  /// Advances time in small fixed steps: wheels turn, frames are exposed, CAN frames are transmitted. A
  /// remainder shorter than a step is carried over to the next call.
  void advance(Duration by);
  /// Starts at Stamp{}.
  [[nodiscard]] Stamp now() const;

  Camera& camera();
  CanBus& can();
  /// Null when the robot has none.
  Scanner* scanner();
  /// Likewise.
  DepthCamera* depth_camera();

  /// All discs as they are now, for pictures and live views.
  [[nodiscard]] const std::vector<DiscState>& discs() const;

  /// The base's firmware, to inject events and defects; it has no access to the pose.
  SimulatedBase& base();

  /// Displaces the robot by `by` in its own frame without turning the wheels.
  void push(const Pose2& by);

  /// Where the `others` are now, in the same order; they stay there until the next call.
  void move_others(std::span<const DiscState> others);

  /// Replaces the true map of obstacles (moved furniture).
  void change_map(const OccupancyMap& map);

  /// Called with every CAN frame on the bus, in both directions, when it is on the wire (for the run's
  /// can.log).
  void on_can_frame(std::function<void(const StampedCanFrame&)> listener);

  /// The faults that have occurred so far, for scoring and reports.
  [[nodiscard]] std::vector<FaultEvent> faults() const;

  /// The scorer, which knows ground truth.
  [[nodiscard]] Scorer& scorer();

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace lodestar
