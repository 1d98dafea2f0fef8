#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "app/goal.hpp"
#include "control/rotate_then_drive.hpp"
#include "control/safety_stop.hpp"
#include "drivers/base_driver.hpp"
#include "localization/marker_detector.hpp"
#include "localization/pose_filter.hpp"
#include "localization/pose_fix.hpp"
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
  GridPlannerOptions planner;
  DriveOptions drive;
  SafetyStopOptions safety;
};

/// All that has arrived since the last step. Time arrives with the data.
struct SensorInput {
  Stamp now;
  std::vector<Frame> frames;
  BaseFeedback base;
};

/// One camera frame that gave a pose, and what the filter made of it.
struct UsedFix {
  PoseFix fix;
  PlanarFix planar;
  FixOutcome outcome = FixOutcome::collecting;
};

/// What one step of the navigator found out and wants.
struct NavigationStep {
  std::vector<UsedFix> fixes;
  std::optional<PoseEstimate> estimate;
  std::optional<StopReason> stop;  ///< why the robot may not move, if so
  BodyVelocity command;
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
  void halt() { drive_.reset(); }

  [[nodiscard]] bool arrived() const { return drive_ && drive_->arrived(); }

 private:
  std::vector<UsedFix> see(const std::vector<Frame>& frames, PoseFilter& filter);

  KnownWorld world_;
  NavigationOptions options_;
  MarkerDetector detector_;
  GridPlanner planner_;
  PoseFilter filter_;
  std::optional<PoseEstimate> estimate_;
  std::optional<RotateThenDrive> drive_;
  std::optional<Stamp> last_step_;
};

}  // namespace lodestar
