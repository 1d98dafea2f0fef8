#pragma once

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "app/live/live_link.hpp"
#include "app/navigation/mission.hpp"

namespace lodestar {

/// The control loop's partner for people at the console: does what they ask for between the steps, and shows
/// them what comes of it. A drive that was asked for over the console goes on only while somebody is at the
/// wheel there.
class OperatorSession {
 public:
  /// `tell`: what happens, in words, for a log.
  explicit OperatorSession(LiveLink& link, std::function<void(const std::string&)> tell = {});

  /// Before a step. `clock` is monotonic_now(), `now` the step's own time.
  void obey(Mission& mission, BaseDriver& base, Stamp now, Stamp clock);

  /// After it. `error_m` is asked for only when somebody watches.
  void show(const SensorInput& input, const MissionStep& step, const Mission& mission,
            const std::function<std::optional<double>()>& error_m = {});

  void say(Stamp now, const std::string& words);

 private:
  void take(const Order& order, Mission& mission, BaseDriver& base, Stamp now);
  void remember(const SensorInput& input, const MissionStep& step, const Mission& mission);

  LiveLink& link_;
  std::function<void(const std::string&)> tell_;
  std::vector<Goal> next_goals_;  ///< when the robot has come to rest
  bool by_console_ = false;       ///< the present drive was asked for there
  std::deque<DriveEvent> events_;
  std::uint64_t said_ = 0;
  std::optional<FixAttempt> last_fix_;
  std::optional<Frame> last_frame_;
  std::shared_ptr<const Path> path_;
  std::string condition_;  ///< of base and safety stop, as last said
};

}  // namespace lodestar
