#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "app/goal.hpp"
#include "app/sight.hpp"
#include "control/free_way.hpp"
#include "control/look_around.hpp"
#include "control/rotate_then_drive.hpp"
#include "control/safety_stop.hpp"
#include "control/speed_limit.hpp"
#include "drivers/base_driver.hpp"
#include "maps/frame.hpp"
#include "planning/grid_planner.hpp"

namespace lodestar {

/// The world as the robot knows it.
struct KnownWorld {
  OccupancyMap map;
  MarkerRegistry registry;
  CameraModel camera;
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();
};

struct NavigationOptions {
  DetectorOptions detector;
  PoseFixOptions fix;
  PoseFilterOptions filter;
  MarkerTrustOptions trust;
  CameraWatchOptions camera;
  DoubtOptions doubt;
  GridPlannerOptions planner;
  DriveOptions drive;
  SafetyStopOptions safety;
  CautionOptions caution;
  LookAroundOptions look_around;
};

/// All that has arrived since the last step. Time arrives with the data.
struct SensorInput {
  Stamp now;
  std::vector<Frame> frames;
  BaseFeedback base;
};

/// What one step of the navigator found out and wants.
struct NavigationStep {
  std::vector<UsedFix> fixes;
  std::optional<PoseEstimate> estimate;
  std::optional<StopReason> stop;  ///< why the robot may not move, if so
  BodyVelocity command;
  std::optional<CameraFault> camera;         ///< what is wrong with it, if anything
  double rolled_unseen_m = 0.0;              ///< by the wheels, since a frame confirmed the estimate
  std::vector<DistrustedMarker> distrusted;  ///< so far
};

/// The road from frames and wheel travel to a velocity.
class Navigation {
 public:
  Navigation(const KnownWorld& world, const NavigationOptions& options);

  /// One step; called at a steady rate. The command is zero while there is no path to follow.
  NavigationStep step(const SensorInput& input);

  /// Plans from where the robot is to the goal, and follows that path from the next step on. Nothing is
  /// followed when planning fails, or when the robot does not know where it is (then nothing is returned).
  std::optional<PlanResult> go_to(const Goal& goal);

  /// Follows nothing any more: the next command is zero.
  void halt();

  /// While it follows nothing: may it turn on the spot to look for a marker when it does not know where it
  /// is?
  void look_for_markers(bool wanted) { looks_for_markers_ = wanted; }

  /// Brings the robot to rest within its limits; then resume() goes on to the same goal.
  void pause();
  void resume();
  [[nodiscard]] bool paused() const { return drive_ && drive_->paused(); }

  /// Brings the robot to rest within its limits and follows nothing any more.
  void cancel();

  [[nodiscard]] bool arrived() const { return drive_ && drive_->arrived(); }

 private:
  [[nodiscard]] SpeedLimit speed_limit(const PoseEstimate& estimate) const;
  [[nodiscard]] DriveOptions drive_options(const Path& path) const;

  KnownWorld world_;
  NavigationOptions options_;
  Sight sight_;
  GridPlanner planner_;
  FreeWay free_way_;
  Whereabouts known_;
  LookAround look_around_;
  RotateThenDrive on_the_spot_;  ///< what moves the robot while it follows nothing
  bool looks_for_markers_ = false;
  double turned_rad_ = 0.0;  ///< by the wheels, since start-up
  std::optional<PoseEstimate> estimate_;
  std::optional<RotateThenDrive> drive_;
  std::optional<Stamp> last_step_;
};

}  // namespace lodestar
