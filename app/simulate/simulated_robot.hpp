#pragma once

#include <optional>
#include <span>
#include <vector>

#include "app/live/robot_state.hpp"
#include "app/navigation/mission.hpp"
#include "app/recording/run_recorder.hpp"
#include "app/simulate/simulated_drive.hpp"
#include "drivers/simulation/simulation.hpp"

namespace lodestar {

/// A simulated world, the robot in it, and the record of its drive. Refers to site and options, which must
/// live as long.
class SimulatedRobot {
 public:
  static constexpr Duration control_period = std::chrono::milliseconds(20);

  SimulatedRobot(const Site& site, const SimulatedDriveOptions& options);

  /// One control period of the world, and one step of the navigator.
  MissionStep step(OperatorSession* session = nullptr);

  /// From now on, for the mission's goals.
  void begin_record();
  [[nodiscard]] RunRecord end_record();
  [[nodiscard]] bool recording() const { return recorder_.is_on(); }
  /// What has been driven without a record.
  [[nodiscard]] const ConductedDrive& unrecorded() const { return unrecorded_; }

  /// Where the other robots of the same world are; always as many as the options had.
  void move_others(std::span<const DiscState> others) { simulation_.move_others(others); }

  [[nodiscard]] Mission& mission() { return mission_; }
  [[nodiscard]] BaseDriver& base() { return base_; }
  [[nodiscard]] const Scorer& scorer() { return simulation_.scorer(); }
  [[nodiscard]] Stamp now() const { return simulation_.now(); }

 private:
  void score(MissionEvent event);
  void forget();
  void score_backtrack(bool goes_back);
  [[nodiscard]] std::optional<TrueError> error_of(const NavigationStep& step);

  const Site& site_;
  const SimulatedDriveOptions& options_;
  KnownWorld world_;
  Simulation simulation_;
  BaseDriver base_;
  Mission mission_;
  RunRecorder recorder_;
  std::vector<std::optional<ArrivalScore>> scores_;
  bool went_back_ = false;
  bool is_placed_ = false;
  ConductedDrive unrecorded_;
  std::optional<TruePose> last_;
};

/// Keeps simulated time no faster than wall time.
class Pace {
 public:
  Pace();
  /// Sleeps until a control period after the last call.
  void keep();

 private:
  Stamp next_;
};

}  // namespace lodestar
