#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "drivers/camera/camera.hpp"
#include "drivers/can/can_bus.hpp"
#include "drivers/simulation/fault.hpp"
#include "drivers/simulation/scoring.hpp"
#include "drivers/simulation/simulated_base.hpp"
#include "drivers/simulation/simulated_camera_options.hpp"
#include "drivers/simulation/simulated_disk.hpp"
#include "maps/camera_model.hpp"
#include "maps/marker_registry.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

/// Everything that the simulated world is made of. The map and registry are the true ones.
struct SimulationOptions {
  SimulatedBaseOptions base;
  SimulatedCameraOptions camera;
  Pose2 start;                   ///< true pose of the base at time 0
  double robot_radius_m = 0.25;  ///< of the disc that runs into obstacles
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();
  Duration physics_step = std::chrono::milliseconds(1);
  Duration scoring_period = std::chrono::milliseconds(20);  ///< between records of the true pose
  std::uint64_t seed = 1;
  std::vector<Fault> faults;
  std::shared_ptr<SimulatedDisk> disk;  ///< of those who keep a record of the drive, if anybody does
};

/// The simulated world as a set of drivers: a camera and a CAN bus, moved along in simulated time. Nothing
/// here tells where the robot really is; that is for the Scorer alone.
class Simulation {
 public:
  /// Throws InputError when the physics step is not positive or the camera's options are not possible.
  Simulation(const OccupancyMap& map, const MarkerRegistry& registry, const CameraModel& camera,
             const SimulationOptions& options);
  ~Simulation();

  /// Moves time on in fixed small steps: wheels turn, frames are exposed, CAN frames travel. What is left of
  /// the last step waits for the next call.
  void advance(Duration by);
  /// Starts at Stamp{}.
  [[nodiscard]] Stamp now() const;

  Camera& camera();
  CanBus& can();

  /// The base, for what people and wear do to it; it does not know where it is.
  SimulatedBase& base();

  /// Somebody pushes the robot, wheels and all: `by` in the robot's own frame.
  void push(const Pose2& by);

  /// Somebody moves the furniture: what stands in the robot's way from now on.
  void change_map(const OccupancyMap& map);

  /// Called with every CAN frame on the bus, either way, when it is on the wire (for the run's can.log).
  void on_can_frame(std::function<void(const StampedCanFrame&)> listener);

  /// What has gone wrong so far; for judges and reports.
  [[nodiscard]] std::vector<FaultEvent> faults() const;

  /// The judge, who sees the truth.
  [[nodiscard]] Scorer& scorer();

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace lodestar
