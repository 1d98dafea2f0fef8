#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/live/live_link.hpp"
#include "app/navigation/charging.hpp"
#include "app/navigation/mission.hpp"

namespace lodestar {

/// The operators at the console, as seen by the control loop: carries out their orders between the steps and
/// publishes the robot's state. A drive ordered from the console goes on only while a client holds the
/// control lease.
class OperatorSession {
 public:
  /// `tell`: receives each event, in words, for a log.
  explicit OperatorSession(LiveLink& link, std::function<void(const std::string&)> tell = {});

  /// Of a robot that has a dock: who brings it there. It must outlive this.
  void use(Charging& charging) { charging_ = &charging; }

  /// Call before a step. `clock` is monotonic_now(), `now` the step's own time.
  void apply_orders(Mission& mission, BaseDriver& base, Stamp now, Stamp clock);

  /// Zones that were set by the orders, handed out once, for the step's input; null when none were.
  [[nodiscard]] std::shared_ptr<const Zones> take_zones() { return std::exchange(zones_, nullptr); }

  /// Call after it. `error` is evaluated only when a state is wanted.
  void publish(const SensorInput& input, const MissionStep& step, const Mission& mission,
               const std::function<std::optional<TrueError>()>& error = {});

  void say(Stamp now, const std::string& words);

 private:
  void end_drive(std::uint64_t ticket, const std::string& why);
  void take(const Order& order, Mission& mission, BaseDriver& base, Stamp now);
  void take(const GoOrder& order, Mission& mission);
  void start_next(Mission& mission);
  void forget_next(const std::string& why);
  void remember(const SensorInput& input, const MissionStep& step, const Mission& mission);

  LiveLink& link_;
  std::function<void(const std::string&)> tell_;
  std::vector<Goal> next_goals_;  ///< to start when the robot has come to rest
  std::uint64_t next_ticket_ = 0;
  bool charges_next_ = false;
  Charging* charging_ = nullptr;
  std::uint64_t ticket_ = 0;      ///< of the present drive
  std::deque<EndedDrive> ended_;  ///< of those with a ticket
  bool by_console_ = false;       ///< the present drive was ordered from the console
  std::shared_ptr<const Zones> zones_;
  std::deque<DriveEvent> events_;
  std::uint64_t said_ = 0;
  std::optional<FixAttempt> last_fix_;
  std::optional<Frame> last_frame_;
  std::shared_ptr<const Path> path_;
  std::string condition_;  ///< of base and safety stop, as last said
};

}  // namespace lodestar
