#pragma once

#include <optional>
#include <vector>

#include "app/navigation/marker_localizer.hpp"
#include "app/navigation/trip_planner.hpp"
#include "app/site/goal.hpp"
#include "control/behaviour.hpp"
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
  IntegrityOptions integrity;
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

/// The road from frames and wheel travel to a velocity. What the robot is about is a state of
/// control/behaviour_states.hpp; docs/behaviours.md says what leads from one to another.
class Navigation {
 public:
  Navigation(const KnownWorld& world, const NavigationOptions& options);

  /// One step; called at a steady rate. The command is zero while there is no path to follow.
  NavigationStep step(const SensorInput& input);

  /// Plans from where the robot stands to the goal, and follows that path from the next step on; nothing is
  /// followed when there is none. Where the robot still rolls, or does not know where it is, nothing is
  /// returned: it comes to rest and finds out, and a later step's `reroute` tells what came of it.
  std::optional<RouteUpdate> go_to(const Goal& goal);

  /// The map as it is from now on. A path that it blocks, or that is clearly worse now, is replaced: the
  /// robot comes to rest and plans anew from there.
  void map_changed(const OccupancyMap& map);

  /// Follows nothing any more: the next command is zero.
  void halt();

  /// While it follows nothing: may it turn on the spot to look for a marker when it does not know where it
  /// is?
  void look_for_markers(bool wanted) { may_look_around_ = wanted; }

  /// Brings the robot to rest within its limits; then resume() goes on to the same goal.
  void pause();
  void resume();
  [[nodiscard]] bool paused() const { return wish_ == Wish::pause; }

  /// Brings the robot to rest within its limits and follows nothing any more.
  void cancel();

  /// Somebody says where the robot stands, to about half a metre and 20 degrees. Markers then tell more.
  /// False while the wheels have not been heard.
  [[nodiscard]] bool place_robot(const Pose2& map_from_base);

  [[nodiscard]] bool arrived() const { return std::holds_alternative<Arrived>(behaviour_.state); }

 private:
  [[nodiscard]] Facts judge(const SensorInput& input, const NavigationStep& step,
                            const LocalizationState& known) const;
  void judge_room(Facts& facts, bool is_contradicted) const;
  Behaviour planned(Behaviour behaviour, const std::optional<PoseEstimate>& estimate,
                    std::optional<RouteUpdate>& update);

  NavigationOptions options_;
  BehaviourOptions behaviour_options_;
  MarkerLocalizer localizer_;
  TripPlanner planner_;
  LocalizationState known_;
  Behaviour behaviour_;
  Wish wish_ = Wish::go_on;
  bool may_look_around_ = false;
  bool map_changed_ = false;  ///< since the last step
  double turned_rad_ = 0.0;   ///< by the wheels, since start-up
  std::optional<PoseEstimate> estimate_;
  std::optional<Stamp> last_step_;
};

}  // namespace lodestar
