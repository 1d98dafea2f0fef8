#pragma once

#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "app/navigation/marker_localizer.hpp"
#include "app/navigation/planning_context.hpp"
#include "app/site/goal.hpp"
#include "control/backtrack.hpp"
#include "control/rotate_then_drive.hpp"
#include "control/safety_margin.hpp"
#include "control/safety_stop.hpp"
#include "control/speed_limit.hpp"
#include "control/spin.hpp"
#include "drivers/base/base_driver.hpp"
#include "maps/frame.hpp"
#include "planning/route.hpp"

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
  IntegrityOptions doubt;
  GridPlannerOptions planner;
  RouteOptions route;
  DriveOptions drive;
  SafetyStopOptions safety;
  CautionOptions caution;
  SpinOptions spin;
  BacktrackOptions backtrack;
};

/// All that has arrived since the last step. Time arrives with the data.
struct SensorInput {
  Stamp now;
  std::vector<Frame> frames;
  BaseFeedback base;
};

/// What one step of the navigator found out and wants.
struct NavigationStep {
  std::vector<FixAttempt> fixes;
  std::optional<PoseEstimate> estimate;
  std::optional<StopReason> stop;  ///< why the robot may not move, if so
  bool backtracks = false;         ///< lost, it goes back to where it saw a marker
  BodyVelocity command;
  std::optional<RouteUpdate> reroute;        ///< the path followed from now on is another one, or lost
  std::optional<CameraFault> camera;         ///< what is wrong with it, if anything
  double rolled_unseen_m = 0.0;              ///< by the wheels, since a frame confirmed the estimate
  std::vector<DistrustedMarker> distrusted;  ///< so far
  Vec2 wheel_scales = Vec2::Ones();          ///< true over reported travel, left and right, as learned so far
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

  /// The map as it is from now on. A path that it blocks, or that is clearly worse now, is replaced: the
  /// robot comes to rest and plans anew from there.
  void map_changed(const OccupancyMap& map);

  /// Follows nothing any more: the next command is zero.
  void halt();

  /// While it follows nothing: may it turn on the spot to look for a marker when it does not know where it
  /// is?
  void look_for_markers(bool wanted) { looks_for_markers_ = wanted; }

  /// Brings the robot to rest within its limits; then resume() goes on to the same goal.
  void pause();
  void resume();
  [[nodiscard]] bool paused() const { return motion_.drive && motion_.drive->paused(); }

  /// Brings the robot to rest within its limits and follows nothing any more.
  void cancel();

  /// Somebody says where the robot stands, to about half a metre and 20 degrees. Markers then tell more.
  /// False while the wheels have not been heard.
  [[nodiscard]] bool place_robot(const Pose2& map_from_base);

  [[nodiscard]] bool arrived() const { return motion_.drive && motion_.drive->arrived(); }

 private:
  /// What moves the robot, and what it is about.
  struct Motion {
    Spin spin;
    RotateThenDrive on_the_spot;  ///< what moves the robot while it follows nothing
    std::optional<RotateThenDrive> drive;
    std::optional<double> goal_heading_rad;
    Backtrack places;                          ///< to go back to
    std::optional<RotateThenDrive> backtrack;  ///< moves the robot instead of `drive` while it goes back
    bool is_lost = false;              ///< too unsure of its pose to go on: it comes to rest, to go back
    bool keeps_to_the_middle = false;  ///< has been too unsure on the way to this goal
    bool seeks_another_way = false;    ///< since it was, or went back
    bool looks_again = false;          ///< at its path: something has changed
    bool reroutes = false;             ///< it comes to rest, to plan anew from there
    bool is_blocked = false;           ///< something stands in front of the robot
  };

  /// What one step is about, besides the motion.
  struct Situation {
    Stamp now;
    Duration elapsed;
    double turned_rad = 0.0;
    std::optional<PoseEstimate> estimate;
    std::optional<StopReason> stop_on_backtrack;  ///< why it may not even go back
    bool is_contradicted = false;                 ///< the estimate, by what was seen last
  };

  static void remember_place(Motion& motion, const NavigationStep& step);
  BodyVelocity move(Motion& motion, const Situation& at, NavigationStep& step) const;
  BodyVelocity follow(Motion& motion, const Situation& at, NavigationStep& step) const;
  void take_another_way(Motion& motion, const Pose2& pose, NavigationStep& step);
  void drive_along(const Path& path, Motion& motion) const;
  void reroute(Motion& motion, const Pose2& pose, NavigationStep& step) const;
  BodyVelocity go_back(Motion& motion, const Situation& at, NavigationStep& step) const;
  [[nodiscard]] std::optional<RotateThenDrive> way_back(Motion& motion, const Pose2& pose) const;
  [[nodiscard]] std::unique_ptr<const PlanningContext> ground_over(const OccupancyMap& map,
                                                                   const Motion& motion) const;
  [[nodiscard]] RouteUpdate route_from(const Motion& motion, const Pose2& pose) const;
  [[nodiscard]] SpeedLimit speed_limit(const Situation& at, const SafetyMargin& spare,
                                       const SafetyStopOptions& limits) const;
  [[nodiscard]] SpeedLimit limit_in_doubt(const Situation& at) const;
  [[nodiscard]] bool is_stuck(const SpeedLimit& limit) const {
    return limit.forward_mps < options_.drive.min_forward_mps;
  }

  NavigationOptions options_;
  MarkerLocalizer localizer_;
  std::unique_ptr<const PlanningContext> ground_;
  LocalizationState known_;
  Motion motion_;
  bool looks_for_markers_ = false;
  double turned_rad_ = 0.0;  ///< by the wheels, since start-up
  std::optional<PoseEstimate> estimate_;
  std::optional<Stamp> last_step_;
};

}  // namespace lodestar
