#pragma once

#include <string>
#include <vector>

#include "app/navigation/navigation.hpp"

namespace lodestar {

struct MissionOptions {
  Duration max_wait_for_start = std::chrono::seconds(25);  ///< for a first pose and a base that obeys
  Duration max_stop = std::chrono::seconds(20);            ///< a safety stop that lasts longer fails the goal
  Duration settle = std::chrono::milliseconds(400);        ///< at rest for so long before arrival is claimed
  /// Arrival is claimed only when a frame has confirmed it: within so much travel, and so near.
  double max_rolled_unseen_m = 0.2;
  double max_distance_at_arrival_m = 0.05;
  int attempts = 3;                 ///< to come so near
  bool hold_on_base_fault = false;  ///< keep the goal until the base is ready again; else it fails
  /// A drive that takes longer than so many times the ideal, and so much more, fails: the robot is stuck.
  double max_time_factor = 4.0;
  Duration max_time_more = std::chrono::seconds(60);
};

/// What a mission is about.
enum class MissionPhase { idle, starting, driving, settling, waiting_for_base, paused, stopping };
/// In words for people.
std::string_view to_string(MissionPhase phase);

enum class MissionEvent { none, path_planned, goal_arrived, goal_failed };

struct MissionStep {
  NavigationStep navigation;
  MissionEvent event = MissionEvent::none;
};

/// Drives to one goal after the other. Time arrives with the data.
class Mission {
 public:
  Mission(const KnownWorld& world, const NavigationOptions& navigation, std::vector<Goal> goals,
          const MissionOptions& options = {});

  MissionStep step(const SensorInput& input);

  /// New goals, once it has finished.
  void start(std::vector<Goal> goals);
  /// Comes to rest within the limits; the goal under way then fails, and those after it are forgotten.
  void stop();
  /// Comes to rest within the limits, until resume().
  void pause();
  void resume();
  [[nodiscard]] bool paused() const { return paused_; }
  /// Somebody says where the robot stands. False while the wheels have not been heard.
  [[nodiscard]] bool place_robot(const Pose2& map_from_base) {
    return navigation_.place_robot(map_from_base);
  }

  [[nodiscard]] MissionPhase phase() const;
  [[nodiscard]] const std::vector<Goal>& goals() const { return goals_; }
  /// The map as it is from now on; the present path is replaced if need be.
  void map_changed(const OccupancyMap& map) { navigation_.map_changed(map); }

  [[nodiscard]] bool finished() const { return current_ >= goals_.size(); }
  [[nodiscard]] std::size_t current() const { return current_; }
  /// The path being followed; valid from path_planned on, which comes again when it is replaced.
  [[nodiscard]] const Path& path() const { return path_; }
  /// What driving that path takes at best, without a glance at the clock for stops, speed limits and
  /// settling.
  [[nodiscard]] double ideal_s() const { return ideal_s_; }
  /// Why the last goal failed, in words.
  [[nodiscard]] const std::string& failure() const { return failure_; }

 private:
  enum class State { starting, driving, settling, held, stopping };

  MissionEvent advance(const SensorInput& input, const NavigationStep& step);
  MissionEvent hold(const SensorInput& input);
  MissionEvent start_goal(const SensorInput& input, const NavigationStep& step);
  MissionEvent take_route(const SensorInput& input, const NavigationStep& step, const RouteUpdate& route);
  void follow_path(const SensorInput& input, const NavigationStep& step, Path path);
  MissionEvent watch_drive(const SensorInput& input, const NavigationStep& step);
  MissionEvent come_to_rest(const SensorInput& input);
  MissionEvent settle(const SensorInput& input, const NavigationStep& step);
  MissionEvent end_goal(Stamp now, MissionEvent event);
  MissionEvent fail(Stamp now, std::string why);

  Navigation navigation_;
  std::vector<Goal> goals_;
  MissionOptions options_;
  State state_ = State::starting;
  std::size_t current_ = 0;
  DriveOptions drive_options_;
  int attempt_ = 0;   ///< at the present goal
  Stamp drive_ends_;  ///< at the latest
  bool paused_ = false;
  Stamp last_step_;
  std::optional<Stamp> since_;  ///< of the present state, or of the present stop while driving
  Path path_;
  double ideal_s_ = 0.0;
  std::string failure_;
};

}  // namespace lodestar
