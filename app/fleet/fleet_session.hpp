#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/fleet/action_hooks.hpp"
#include "app/fleet/fleet_link.hpp"
#include "app/fleet/order_book.hpp"
#include "app/navigation/charging.hpp"
#include "app/navigation/mission.hpp"
#include "app/navigation/wheel_rest.hpp"
#include "app/site/fleet_settings.hpp"
#include "app/site/site.hpp"

namespace lodestar {

struct FleetSessionOptions {
  OrderBookOptions book;
  std::optional<BatteryCurve> battery;
  std::vector<ActionHook> hooks;
  std::optional<ChargingSettings> charging;
  std::filesystem::path folder;  ///< of the site, in which their programs run
  /// The master is asked for more base when this much of it is left: three seconds at full speed, and the
  /// braking distance.
  double ask_for_base_m = 2.0;
  Duration least_interval = std::chrono::milliseconds(100);  ///< between two states
  Duration most_interval = std::chrono::seconds(30);         ///< VDA 5050: a state at least so often
};

FleetSessionOptions fleet_session_options(const Site& site, const FleetSettings& settings);

/// A fleet's master, as seen by the control loop: carries out its orders between the steps, and reports. A
/// person who drives from the console, or by hand, goes before: the order is then cleared.
class FleetSession {
 public:
  /// `tell`: receives each event, in words, for a log.
  FleetSession(FleetLink& link, FleetSessionOptions options,
               std::function<void(const std::string&)> tell = {});

  /// Call before each step with what comes in.
  void hear(const SensorInput& input);
  /// Call after it.
  void attend(const MissionStep& step, Mission& mission);

  [[nodiscard]] const OrderBook& book() const { return book_; }
  /// Who brings the robot onto its dock; null where it has none.
  [[nodiscard]] Charging* charging() { return charging_ ? &*charging_ : nullptr; }

 private:
  struct Wait {
    std::string action;
    Duration left;
  };
  /// What makes a state an event, besides the order book.
  struct Visible {
    std::uint64_t revision = 0;
    std::uint64_t connections = 0;
    bool driving = false;
    bool charging = false;
    bool paused = false;
    bool wants_base = false;
    bool field_violation = false;
    EmergencyStop emergency_stop = EmergencyStop::none;

    bool operator==(const Visible&) const = default;
  };

  void follow(const MissionStep& step, Mission& mission);
  void stop(Mission& mission);
  void see_who_drives(const Mission& mission);
  void take_messages(const NavigationStep& step);
  void hold(Mission& mission);
  void act(Mission& mission);
  void begin(const FleetAction& action, Mission& mission);
  void place(const FleetAction& action, Mission& mission);
  void charge(const FleetAction& action, Mission& mission);
  void go_on_waiting();
  void go_on_charging();
  void drive(Mission& mission);
  void note_stop(const NavigationStep& step);
  void report(const NavigationStep& step, const Mission& mission);
  [[nodiscard]] FleetReport report_of(const NavigationStep& step, const Visible& visible) const;
  [[nodiscard]] bool wants_base(const NavigationStep& step) const;
  void say(const std::string& words) const;

  FleetLink& link_;
  FleetSessionOptions options_;
  std::function<void(const std::string&)> tell_;
  OrderBook book_;
  WheelRest wheels_;
  Stamp now_;
  Duration elapsed_{};  ///< since the step before
  BaseFeedback base_;   ///< without its travel
  std::optional<WheelTravel> travel_;
  double driven_m_ = 0.0;  ///< by the wheels, since the last node
  std::uint32_t node_of_driven_ = 0;
  std::vector<DriveTarget> targets_;  ///< of the present drive, by the mission's goals
  bool is_ours_ = false;              ///< the present drive is by the master's order
  bool is_stopped_by_us_ = false;
  bool has_paused_ = false;  ///< the present drive
  std::vector<Wait> waits_;
  ActionHooks hooks_;
  std::optional<Charging> charging_;
  std::optional<std::string> charge_action_;
  std::string stop_;  ///< why the robot may not move, and since when
  std::optional<Stamp> stop_since_;
  bool is_state_asked_ = false;
  std::optional<Visible> reported_;
  Stamp reported_at_;
};

}  // namespace lodestar
