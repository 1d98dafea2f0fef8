#pragma once

#include <string>
#include <variant>
#include <vector>

#include "app/navigation/navigation.hpp"
#include "app/navigation/rest.hpp"
#include "app/navigation/wheel_rest.hpp"

namespace lodestar {

struct MissionOptions {
  Duration max_wait_for_start = std::chrono::seconds(25);  ///< for a first pose and a ready base
  Duration max_stop = std::chrono::seconds(20);            ///< a safety stop that lasts longer fails the goal
  Duration settle = std::chrono::milliseconds(400);        ///< time at rest before arrival is reported
  Duration max_unrest = std::chrono::seconds(10);          ///< a robot not at rest by then fails the goal
  /// Arrival needs a frame that confirmed the estimate within this travel, and the robot's own epsilon of
  /// Eq. (19).
  double max_rolled_unseen_m = 0.2;
  /// Of a passed goal where the trip ends: so near it counts as passed; as RouteOptions::left_path_m.
  double pass_within_m = 0.2;
  Duration max_wait = std::chrono::seconds(60);  ///< the same for a thing that may go away
  /// Slowed or stopped by people or things for so long while it comes no `progress_m` nearer to the goal
  /// along its path, it fails; the time is not counted below. Chosen by hand: in rooms whose people never
  /// stop walking, half of the drives that gave up after five minutes arrive within ten.
  Duration max_hindered = std::chrono::minutes(10);
  /// A goal's action that has not been taken (take_action) by then fails: this program carries none out.
  Duration max_action_begin = std::chrono::seconds(5);
  double progress_m = 1.0;
  int attempts = 3;                 ///< to come within epsilon
  bool hold_on_base_fault = false;  ///< keep the goal until the base is ready again; else it fails
  /// A drive longer than max_time_factor times the ideal time plus max_time_more fails: the robot is stuck.
  double max_time_factor = 4.0;
  Duration max_time_more = std::chrono::seconds(60);
};

enum class MissionPhase {
  idle,
  by_hand,
  starting,
  driving,
  settling,
  at_stop,
  waiting_for_base,
  paused,
  stopping
};
/// Text for the operator.
std::string_view to_string(MissionPhase phase);

enum class MissionEvent { none, path_planned, goal_passed, goal_arrived, goal_failed };

struct MissionStep {
  NavigationStep navigation;
  MissionEvent event = MissionEvent::none;
};

/// Drives to the goals in turn. Goals that are only passed and the next one that is not are one trip, with
/// one path; where one of them fails, so do those after it. Time arrives with the data.
class Mission {
 public:
  Mission(const KnownWorld& world, const NavigationOptions& navigation, std::vector<Goal> goals,
          const MissionOptions& options = {});

  MissionStep step(const SensorInput& input);

  /// Starts new goals; call only when finished().
  void start(std::vector<Goal> goals);
  /// More goals behind the last one, also while driving: where that one is only passed, the robot does not
  /// brake for it. When finished(), the robot starts for them.
  void append(std::vector<Goal> goals);
  /// The last goal becomes one that is only passed, where it asks for no heading and the robot does not
  /// settle there yet. Call before append(), for a goal that was only the last one known.
  void pass_last();
  /// Brakes to rest within the limits; then the present goal fails, and those after it are dropped.
  void stop();
  /// Brakes to rest within the limits, until resume().
  void pause();
  void resume();
  [[nodiscard]] bool paused() const { return paused_; }

  /// The action that is to be carried out where the robot stands now, handed out once; empty for none. Then
  /// tell its end: empty, or why it failed, which ends the drive.
  [[nodiscard]] std::string take_action();
  void action_ended(std::string why_failed);
  /// One has been handed out, and its end is waited for.
  [[nodiscard]] bool awaits_action() const;

  /// Moves by hand at this velocity until then, as Navigation::steer() does; call only when finished().
  void steer(const BodyVelocity& wanted, Stamp until);
  /// Sets the initial pose, as Navigation::place_robot() does.
  [[nodiscard]] bool place_robot(const Pose2& map_from_base, const PlacingSigma& sigma = {}) {
    return navigation_.place_robot(map_from_base, sigma);
  }

  [[nodiscard]] MissionPhase phase() const;
  [[nodiscard]] const std::vector<Goal>& goals() const { return goals_; }
  /// Sets a new map; the present path is replaced if need be.
  void map_changed(OccupancyMap map) { navigation_.map_changed(std::move(map)); }

  /// Goes by these markers from now on.
  void registry_changed(const MarkerRegistry& registry) { navigation_.registry_changed(registry); }

  [[nodiscard]] bool finished() const { return current_ >= goals_.size(); }
  [[nodiscard]] std::size_t current() const { return current_; }
  /// The path being followed; valid from path_planned on, which comes again when it is replaced.
  [[nodiscard]] const Path& path() const { return path_; }
  /// Ideal driving time of that path, without stops, speed limits and settling.
  [[nodiscard]] double ideal_s() const { return ideal_s_; }
  /// What the scanner shows around the robot, as Navigation::seen() does.
  [[nodiscard]] std::optional<SeenSurroundings> seen(Stamp now) const { return navigation_.seen(now); }
  /// What the robot has learned so far, to begin with after a restart.
  [[nodiscard]] std::optional<LearnedState> learned() const { return navigation_.learned(); }
  /// Why the last goal failed, as text.
  [[nodiscard]] const std::string& failure() const { return failure_; }

 private:
  /// Waits until it may drive to the present goal.
  struct Starting {
    std::optional<Stamp> since;
  };
  struct Stopped {
    Stamp since;
    Duration patience;  ///< with the reason not to move
  };
  struct Driving {
    Stamp ends;  ///< deadline
    std::optional<Stopped> stopped;
  };
  /// At the goal; reports arrival after a time at rest with the pose confirmed.
  struct Settling {
    std::optional<Stamp> since;  ///< arrival at the goal, or the last rest there
    std::optional<Stamp> still_since;
  };
  /// Reached, but for what is to be done there.
  struct AtStop {
    std::optional<Stamp> since;
    bool action_begun = false;
    bool action_done = false;
    std::string failure;  ///< of the action
  };
  /// Holds the goal while the base has a fault.
  struct Held {};
  /// Cancelled by the operator: brakes to rest, then the goal fails.
  struct Stopping {
    std::optional<Stamp> since;
  };
  using State = std::variant<Starting, Driving, Settling, AtStop, Held, Stopping>;

  [[nodiscard]] bool at_rest() const { return rest_.at_rest() || wheels_.holds(); }
  MissionEvent advance(const SensorInput& input, const NavigationStep& step);
  MissionEvent advance(Starting state, const SensorInput& input, const NavigationStep& step);
  MissionEvent advance(Driving state, const SensorInput& input, const NavigationStep& step);
  MissionEvent advance(Settling state, const SensorInput& input, const NavigationStep& step);
  MissionEvent advance(AtStop state, const SensorInput& input, const NavigationStep& step);
  MissionEvent advance(Held state, const SensorInput& input, const NavigationStep& step);
  MissionEvent advance(Stopping state, const SensorInput& input, const NavigationStep& step);
  MissionEvent wait_to_start(const Starting& state, const SensorInput& input, const NavigationStep& step);
  /// The goals from the present one to the next that is not only passed.
  [[nodiscard]] std::vector<Goal> trip() const;
  MissionEvent end_pass();
  MissionEvent arrive(Stamp now);
  [[nodiscard]] Duration patience_with(StopReason reason) const;
  [[nodiscard]] bool is_hindered_too_long(const SensorInput& input, const NavigationStep& step);
  [[nodiscard]] double distance_to_goal_m(const PoseEstimate& estimate) const;
  MissionEvent hold(const SensorInput& input);
  MissionEvent apply_route(Driving state, const SensorInput& input, const NavigationStep& step,
                           const RouteUpdate& route);
  MissionEvent end_goal(Stamp now, MissionEvent event);
  MissionEvent fail(Stamp now, std::string why);

  Navigation navigation_;
  std::vector<Goal> goals_;
  MissionOptions options_;
  State state_ = Starting{};
  std::size_t current_ = 0;
  std::size_t trip_start_ = 0;  ///< the goal with which the present trip began
  std::size_t failed_to_ = 0;   ///< goals before this one are of a trip that failed
  DriveOptions drive_options_;
  RestDetector rest_;
  int attempt_ = 0;               ///< at the present goal
  Duration hindered_{};           ///< since the last progress on the way to the present goal
  std::optional<double> left_m_;  ///< to it at the last progress
  bool paused_ = false;           ///< by the operator, in any of these states
  WheelRest wheels_;
  Stamp last_step_;
  std::optional<Stamp> steered_until_;
  Path path_;
  double ideal_s_ = 0.0;
  std::string failure_;
};

}  // namespace lodestar
