#pragma once

#include <functional>
#include <memory>

#include "app/navigation/learned_state.hpp"
#include "app/placement/uncertainty_constraint.hpp"
#include "app/recording/drive_moment.hpp"
#include "app/report/run_record.hpp"
#include "app/simulate/disturbances.hpp"
#include "app/site/site.hpp"
#include "drivers/simulation/fault.hpp"
#include "drivers/simulation/moving_disc.hpp"
#include "drivers/simulation/overhang.hpp"
#include "drivers/simulation/scoring.hpp"
#include "drivers/simulation/simulated_disk.hpp"
#include "drivers/simulation/simulated_scanner.hpp"
#include "drivers/simulation/sliding_door.hpp"
#include "drivers/simulation/walkers.hpp"
#include "planning/grid_planner.hpp"

namespace lodestar {

class OperatorSession;

struct SimulatedDriveOptions {
  std::string camera;  ///< a profile of the site
  std::uint64_t seed = 1;
  std::vector<Goal> goals;
  PlannerKind planner = PlannerKind::fastest;
  std::optional<UncertaintyConstraint> uncertainty_constraint;  ///< of the paths
  std::optional<LearnedState> learned;                          ///< in an earlier drive
  Disturbances disturbances;
  std::vector<Fault> faults;
  std::shared_ptr<SimulatedDisk> disk;             ///< disk faults act on it, if given
  std::optional<SimulatedScannerOptions> scanner;  ///< without it: the robot's own, if it has one
  PeopleOptions people;                            ///< who walk about
  std::vector<MovingDisc> discs;                   ///< that no map has
  std::vector<SlidingDoor> doors;                  ///< likewise
  std::vector<Overhang> overhangs;                 ///< likewise
  std::vector<DiscState> others;                   ///< robots in the same world, as at the start
  bool is_placed_at_start = false;                 ///< a person says where it starts, to 2 cm and 1 degree
  /// Asked after each step what the judge of the simulated world says; true ends the drive where it is.
  std::function<bool(const Scorer&)> is_over;
  std::optional<double> battery_v;  ///< at rest, at the start, of a robot that has a dock
  double pictures_hz = 0.0;         ///< camera frames to keep in the record
  bool realtime = false;            ///< simulated time runs no faster than wall time
  std::function<bool()> goes_on;    ///< asked after each step; false ends the drive where it is
  std::function<bool()> stays_on;   ///< asked when the last goal is done; true: the drive is not over yet
  /// Called after each step of the navigator with the wall time that it took.
  std::function<void(std::chrono::nanoseconds)> on_step;
  std::function<void(double)> progress;              ///< called repeatedly with the completed share, 0..1
  DriveWatcher watch;                                ///< called during the drive
  std::function<void(const SensorInput&)> on_input;  ///< hears of all input, in drives and between
  /// Takes part after each step, in drives and between.
  std::function<void(const SensorInput&, const MissionStep&, Mission&)> attend;

  /// Anything in its way that no map has, and that a judge of contacts looks at?
  [[nodiscard]] bool has_people_or_things() const {
    return people.count > 0 || !discs.empty() || !doors.empty();
  }
};

/// Drives the simulated robot through the goals: the same navigator as on the real one, simulated drivers.
RunRecord simulate_drive(const Site& site, const SimulatedDriveOptions& options);

/// A drive whose mission is decided on as it goes.
struct ConductedDrive {
  int contacts = 0;  ///< with the map, one from touch to release
  int touches = 0;   ///< by the moving robot, of the map, of people and of other robots, likewise
  double driven_m = 0.0;
  Duration driven{};
};

/// Drives until `conduct`, called after each step, returns false. Nothing is recorded but what `options`
/// hear.
ConductedDrive simulate_conducted_drive(const Site& site, const SimulatedDriveOptions& options,
                                        const std::function<bool(const MissionStep&, Mission&)>& conduct);

/// The same with an operator session: after the goals the robot stands and waits for more, until `goes_on`
/// returns false. `keep` gets the record of each drive as it ends. While the robot stands, simulated time
/// runs no faster than wall time.
void simulate_attended_drive(const Site& site, const SimulatedDriveOptions& options, OperatorSession& session,
                             const std::function<bool()>& goes_on,
                             const std::function<void(RunRecord)>& keep);

}  // namespace lodestar
