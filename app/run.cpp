#include "app/run.hpp"

#include <fmt/format.h>

#include "app/camera_watch.hpp"
#include "app/mission.hpp"
#include "app/navigation_setup.hpp"
#include "app/report/run_recorder.hpp"
#include "drivers/clock.hpp"
#include "drivers/recorded_bus.hpp"

namespace lodestar {
namespace {

constexpr Duration control_period = std::chrono::milliseconds(20);

/// Tells people what changes about the base.
class BaseWatcher {
 public:
  explicit BaseWatcher(const RunOptions& options) : options_(options) {}

  void see(const BaseFeedback& base) {
    std::string words = fmt::format("base: {}", to_string(base.state));
    if (base.fault) words += fmt::format(" ({})", to_string(*base.fault));
    if (base.state == BaseState::fault && options_.hold_on_base_fault) words += "; resume or stop?";
    if (words == said_) return;
    options_.tell(words);
    said_ = std::move(words);
  }

 private:
  const RunOptions& options_;
  std::string said_;
};

std::string in_words(const Mission& mission, MissionEvent event) {
  switch (event) {
    case MissionEvent::none:
      return "";
    case MissionEvent::path_planned:
      return fmt::format("goal {}: a path of {:.2f} m", mission.current() + 1, length_m(mission.path()));
    case MissionEvent::goal_arrived:
      return fmt::format("goal {}: arrived", mission.current());
    case MissionEvent::goal_failed:
      return fmt::format("goal {}: failed: {}", mission.current(), mission.failure());
  }
  return "";
}

/// More frames than a camera sends in a period wait for the next one: to catch up must not hold commands up.
SensorInput sense(Camera& camera, BaseDriver& base) {
  constexpr std::size_t most_frames = 2;
  const Stamp now = monotonic_now();
  SensorInput input{.now = now, .frames = {}, .base = base.poll(now)};
  while (input.frames.size() < most_frames) {
    std::optional<Frame> frame = camera.poll();
    if (!frame) break;
    input.frames.push_back(std::move(*frame));
  }
  return input;
}

/// False when the robot shall stop for good.
bool obey(OperatorWish wish, BaseDriver& base, const RunOptions& options) {
  if (wish == OperatorWish::stop) return false;
  if (wish == OperatorWish::resume && !base.resume(monotonic_now())) {
    options.tell("base: cannot resume, the cause is still there");
  }
  return true;
}

}  // namespace

RunRecord run(const Site& site, CanBus& bus, std::unique_ptr<BaseProtocol> protocol, Camera& camera,
              const RunOptions& options) {
  RunRecord record;
  record.site = site.name;
  record.camera = options.camera;
  record.robot_radius_m = site.robot.radius_m;
  for (const Goal& goal : options.goals) record.goals.push_back({.goal = goal});

  RecordedBus recorded(bus, [&record](const StampedCanFrame& frame) { record.can_frames.push_back(frame); });
  BaseDriver base(recorded, std::move(protocol));
  BaseWatcher watcher(options);
  CameraWatch camera_watch;
  Mission mission(known_world(site, options.camera), navigation_options(site.robot), options.goals,
                  {.hold_on_base_fault = options.hold_on_base_fault});

  const Stamp start = monotonic_now();
  Stamp next = start;
  while (!mission.finished() && obey(options.operator_wish(), base, options)) {
    next = std::max(next + control_period, monotonic_now());
    sleep_until(next);
    const SensorInput input = sense(camera, base);
    const MissionStep step = mission.step(input);
    base.command(step.navigation.command);

    watcher.see(input.base);
    if (const auto words = camera_watch.see(input.now, input.frames.size())) options.tell(*words);
    record_step(record, input, step.navigation);
    record_event(record, mission, step.event, input.now);
    if (const std::string words = in_words(mission, step.event); !words.empty()) options.tell(words);
  }
  base.command({});
  if (!mission.finished()) record.goals[mission.current()].failure = "stopped by the operator";
  record.wall_time_s = seconds(monotonic_now() - start);
  return record;
}

}  // namespace lodestar
