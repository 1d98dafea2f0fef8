#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "app/navigation/background_planner.hpp"
#include "app/navigation/learned_state.hpp"
#include "app/navigation/marker_localizer.hpp"
#include "app/navigation/surroundings.hpp"
#include "app/navigation/trip_goals.hpp"
#include "app/site/goal.hpp"
#include "control/behaviour.hpp"
#include "control/zone_speed.hpp"
#include "drivers/base/base_driver.hpp"
#include "maps/frame.hpp"
#include "maps/scan.hpp"
#include "maps/zones.hpp"
#include "planning/route.hpp"

namespace lodestar {

/// The world model.
struct KnownWorld {
  OccupancyMap map;
  MarkerRegistry registry;
  CameraModel camera;
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();
  Zones zones;
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
  PlanArrivalOptions plan_arrival;
  DriveOptions drive;
  SafetyStopOptions safety;
  CautionOptions caution;
  SpinOptions spin;
  BacktrackOptions backtrack;
  SteeringOptions steering;
  std::optional<SurroundingsOptions> surroundings;  ///< of a robot with a scanner
  std::optional<LearnedState> learned;              ///< in an earlier drive
};

/// All data since the last step. Time arrives with the data.
struct SensorInput {
  Stamp now;
  std::vector<Frame> frames;
  BaseFeedback base;
  std::vector<Scan> scans;
  std::vector<DepthImage> depths;
  ScanPackets packets;                           ///< of the scanner, since the beginning
  std::shared_ptr<const Zones> zones = nullptr;  ///< that people have set since the last step, if so
};

/// How exactly a person says where the robot is; by default as with a click on the map.
struct PlacingSigma {
  double position_m = 0.25;
  double heading_rad = radians(10.0);
};

/// Result of one navigation step.
struct NavigationStep {
  std::vector<FixAttempt> fixes;
  std::optional<PoseEstimate> estimate;
  std::optional<StopReason> stop;  ///< why the robot must not move, if so
  bool backtracks = false;         ///< lost, the robot drives back to where it saw a marker
  BodyVelocity command;
  bool is_slowed = false;                    ///< by the protective field
  std::optional<double> zone_mps;            ///< what a zone or the leg allows, where less than the robot can
  std::optional<StopReason> slowed_by;       ///< why the field allows less than is wanted
  std::optional<RouteUpdate> reroute;        ///< the path is replaced, or lost
  std::optional<CameraFault> camera;         ///< present fault of the camera
  double rolled_unseen_m = 0.0;              ///< wheel travel since a frame confirmed the estimate
  std::vector<DistrustedMarker> distrusted;  ///< so far
  Vec2 wheel_scales = Vec2::Ones();          ///< true over reported travel, left and right, as learned so far
};

/// From frames and wheel travel to a velocity. control/behaviour_states.hpp has the states,
/// docs/behaviours.md the transitions.
class Navigation {
 public:
  Navigation(const KnownWorld& world, const NavigationOptions& options);

  /// One step; call at a steady rate. Without a path to follow, the robot brakes, stands or spins.
  NavigationStep step(const SensorInput& input);

  /// Plans a path from the robot to the goal and follows it; with no path, the robot stands. A later step's
  /// `reroute` has the result: the robot comes to rest and localizes first, and a plan takes some steps.
  void go_to(const Goal& goal) { go_over({goal}); }

  /// The same over goals in turn, in one path: the robot passes all but the last without settling, and
  /// without a stop where the way goes straight on.
  void go_over(std::vector<Goal> goals);

  /// More goals behind the last one of the trip, which is passed then. While the robot drives it does not
  /// brake for that: a later step's `reroute` has the longer path. Only of a trip under way.
  void extend(std::span<const Goal> goals);

  /// Goals passed on this trip; at its end all but the last to which the path leads.
  [[nodiscard]] std::size_t passed() const { return arrived() ? goals_.before_end() : goals_.passed(); }

  /// Sets a new map, in use some steps later, with the same zones. When it blocks the path or makes another
  /// clearly faster, the robot brakes to rest and replans from there.
  void map_changed(OccupancyMap map) { planner_.use_map(std::move(map)); }

  /// Goes by these markers from now on: a survey under way knows more of them, and better.
  void registry_changed(const MarkerRegistry& registry) { localizer_.use_registry(registry); }

  /// Drops the path: the next command is zero.
  void halt();

  /// Moves by hand at this velocity, while the robot is on no trip; call again before the order ends, or it
  /// brakes to rest. Slow (SteeringOptions), and where the pose is known only as far as the map is free.
  void steer(const BodyVelocity& wanted, Stamp until) { steering_ = Steering{wanted, until}; }

  /// Allows the robot, while it follows no path and its pose is lost, to spin to look for a marker.
  void look_for_markers(bool wanted) { may_look_around_ = wanted; }

  /// Brakes to rest within the limits; then resume() goes on to the same goal.
  void pause();
  void resume();
  [[nodiscard]] bool paused() const { return wish_ == Wish::pause; }

  /// Brakes to rest within the limits and drops the path.
  void cancel();

  /// Sets the initial pose, which marker fixes then refine. False before the first wheel reading.
  [[nodiscard]] bool place_robot(const Pose2& map_from_base, const PlacingSigma& sigma = {});

  /// What has been learned so far, in this drive and those before it. Nothing while the pose is unknown.
  [[nodiscard]] std::optional<LearnedState> learned() const;

  /// What the scanner shows around the robot; nothing without one, or before its first scan.
  [[nodiscard]] std::optional<SeenSurroundings> seen(Stamp now) const;

  [[nodiscard]] bool arrived() const { return std::holds_alternative<Arrived>(behaviour_.state); }

 private:
  void use_zones(const Zones& zones);
  [[nodiscard]] Facts judge(const SensorInput& input, const NavigationStep& step, bool map_changed) const;
  std::optional<double> speed_limit(const PoseEstimate& estimate);
  void judge_room(Facts& facts) const;
  [[nodiscard]] MappedPose mapped_pose(const Facts& facts) const;
  void look_around(const SensorInput& input, Facts& facts);
  void plan_around_obstacles(const Facts& facts);
  void protect(const SensorInput& input, Duration elapsed, Moved& after, NavigationStep& step);
  Behaviour planned(Behaviour behaviour, const std::optional<PoseEstimate>& estimate,
                    std::optional<RouteUpdate>& update);

  NavigationOptions options_;
  ZoneSpeed zone_speed_;
  BehaviourOptions behaviour_options_;
  MarkerLocalizer localizer_;
  BackgroundPlanner planner_;
  std::optional<Surroundings> surroundings_;
  TripGoals goals_;
  bool has_new_goal_ = false;  ///< whose first path must go around what is known to stand about
  LocalizationState known_;
  Behaviour behaviour_;
  Wish wish_ = Wish::go_on;
  bool may_look_around_ = false;
  struct Steering {
    BodyVelocity wanted;
    Stamp until;
  };
  std::optional<Steering> steering_;
  double turned_rad_ = 0.0;  ///< by the wheels, since start-up
  std::optional<PoseEstimate> estimate_;
  std::optional<Stamp> last_step_;
};

}  // namespace lodestar
