#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "app/navigation/mission.hpp"
#include "app/site/charging_settings.hpp"

namespace lodestar {

struct ChargingOptions {
  /// For the contacts to close, and the charger to find the battery: many ask it first, and ramp up.
  Duration max_connecting = std::chrono::seconds(30);
  Duration confirm = std::chrono::seconds(2);  ///< a voltage counts when it has lasted so long
  /// Of standing without a goal, before it goes to charge by itself: by then the load of the drive no longer
  /// shows in the voltage, and whoever stands beside the robot has read that it will go.
  Duration idle = std::chrono::seconds(30);
};

enum class ChargingState { none, driving, connecting, charging, full };
/// Text for the operator; empty for none.
std::string_view to_string(ChargingState state);

/// Brings the robot onto its dock and watches the battery there: that it charges, and until it is full. Only
/// the voltage tells; all bases report that.
class Charging {
 public:
  /// `tell`: receives each event, in words, for a log.
  explicit Charging(ChargingSettings settings, std::function<void(const std::string&)> tell = {},
                    const ChargingOptions& options = {});

  /// To a pose straight in front of the dock, and from there slowly onto it.
  [[nodiscard]] std::vector<Goal> goals() const;
  /// Sends the robot there: at once where the mission is finished, else after its last goal.
  void begin(Mission& mission);
  /// The mission has the goals already, the last of them at this place among its goals.
  void expect(std::size_t dock);

  /// Call after each step with what came in before it.
  void watch(Stamp now, const BaseFeedback& base, const MissionStep& step, Mission& mission);

  [[nodiscard]] ChargingState state() const { return state_; }
  /// To be called when a master says that it is enough. The robot stays where it is.
  void end();
  /// On its way to the battery's charge, or at it.
  [[nodiscard]] bool is_under_way() const {
    return state_ != ChargingState::none && state_ != ChargingState::full;
  }
  /// Why the last attempt failed; empty where it did not.
  [[nodiscard]] const std::string& failure() const { return failure_; }
  /// A person has moved the dock's place on the map: from the next drive there on.
  void dock_moved(const Pose2& map_from_dock) { settings_.map_from_dock = map_from_dock; }

 private:
  void watch_drive(const MissionStep& step, Mission& mission);
  void watch_contacts();
  void watch_charge();
  void watch_level(const BaseFeedback& base, Mission& mission);
  [[nodiscard]] bool has_lasted(bool holds, Duration how_long);
  void enter(ChargingState state, const std::string& words);
  void fail(const std::string& why);

  ChargingSettings settings_;
  std::function<void(const std::string&)> tell_;
  ChargingOptions options_;
  ChargingState state_ = ChargingState::none;
  std::size_t dock_ = 0;  ///< among the mission's goals
  std::string failure_;
  Stamp now_;
  Stamp entered_;  ///< the present state
  std::optional<Stamp> holds_since_;
  std::optional<Stamp> idle_since_;
  bool goes_by_itself_ = true;  ///< when low; not again after a failure, until someone has driven it
  double battery_v_ = 0.0;      ///< 0: not reported
  double rest_v_ = 0.0;         ///< before the contacts touch
};

}  // namespace lodestar
