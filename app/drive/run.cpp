#include "app/drive/run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/drive/sensing.hpp"
#include "app/drive/state_keeper.hpp"
#include "app/live/operator_session.hpp"
#include "app/navigation/mission.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "app/recording/run_recorder.hpp"
#include "app/site/base_setup.hpp"
#include "drivers/can/recorded_bus.hpp"
#include "drivers/system/clock.hpp"

namespace lodestar {
namespace {

constexpr Duration control_period = std::chrono::milliseconds(20);

/// Reports changes of the base's state.
class BaseWatcher {
 public:
  explicit BaseWatcher(const RunOptions& options) : options_(options) {}

  void see(const BaseFeedback& base, const std::vector<std::string>& warnings) {
    std::string words = "base: " + in_words(base.state, base.fault, base.details);
    if (options_.hold_on_base_fault) words += hint(base);
    if (words != said_)
      options_.tell(base.state == BaseState::fault ? Severity::warning : Severity::info, words);
    said_ = std::move(words);
    if (warnings != warned_ && !warnings.empty())
      options_.tell(Severity::warning, fmt::format("base: reports {}", fmt::join(warnings, ", ")));
    warned_ = warnings;
  }

 private:
  /// What the operator may type.
  static std::string_view hint(const BaseFeedback& base) {
    if (base.state == BaseState::fault) return "; resume or stop?";
    if (base.state != BaseState::waiting_for_base || !base.fault) return "";
    return is_reported_by_base(*base.fault) ? "; resume asks it to clear that" : "";
  }

  const RunOptions& options_;
  std::string said_;
  std::vector<std::string> warned_;
};

/// Reports changes of the camera's state.
class CameraWatcher {
 public:
  explicit CameraWatcher(const RunOptions& options) : options_(options), start_(monotonic_now()) {}

  void see(const SensorInput& input, std::optional<CameraFault> fault) {
    constexpr Duration patience = std::chrono::seconds(2);  // while the camera starts up
    has_seen_ = has_seen_ || !input.frames.empty();
    const bool is_missed = !has_seen_ && input.now - start_ > patience;
    const std::string_view words = is_missed ? to_string(CameraFault::silent)
                                   : fault   ? to_string(*fault)
                                             : "";
    if (words == said_) return;
    if (words.empty()) {
      options_.tell(Severity::info, "camera: frames are usable again");
    } else {
      options_.tell(Severity::warning, fmt::format("camera: {}", words));
    }
    said_ = words;
  }

 private:
  const RunOptions& options_;
  Stamp start_;
  bool has_seen_ = false;
  std::string said_;
};

/// False when the run is to end.
bool apply(OperatorWish wish, BaseDriver& base, const RunOptions& options) {
  if (wish == OperatorWish::stop) return false;
  if (wish == OperatorWish::none) return true;
  const bool is_waiting = base.state() == BaseState::waiting_for_base;
  if (!base.resume(monotonic_now())) {
    options.tell(Severity::warning, "base: cannot resume, the cause is still there");
  } else if (is_waiting) {
    options.tell(Severity::info, "base: asked to clear its fault");
  }
  return true;
}

/// Applies the orders of the operator session before a step.
void attend(const RunOptions& options, Mission& mission, BaseDriver& base, RunRecorder& recorder) {
  if (options.session == nullptr) return;
  if (recorder.is_on() && mission.finished()) options.keep({recorder.end(mission)});
  const Stamp now = monotonic_now();
  options.session->apply_orders(mission, base, now, now);
  if (!mission.finished() && !recorder.is_on()) recorder.begin(mission.goals());
}

}  // namespace

RunRecord run(const Site& site, CanBus& bus, std::unique_ptr<BaseProtocol> protocol, Camera& camera,
              const RunOptions& options) {
  RunRecorder recorder(
      site, {.camera = options.camera, .pictures_hz = options.pictures_hz, .watch = options.watch});
  if (!options.goals.empty()) recorder.begin(options.goals);
  RecordedBus recorded(bus, [&recorder](const StampedCanFrame& frame) { recorder.take(frame); });
  const BaseDriverOptions driver_options = base_driver_options(site.robot, *protocol);
  BaseDriver base(recorded, std::move(protocol), driver_options);
  BaseWatcher watcher(options);
  CameraWatcher camera_watcher(options);
  StateKeeper keeper(options.state.empty() ? state_file(site) : options.state,
                     state_owner(site, options.camera), options.tell);
  NavigationOptions navigation = navigation_options(site.robot);
  navigation.learned = keeper.load();
  navigation.plan_arrival.waits = false;
  Mission mission(known_world(site, options.camera), navigation, options.goals,
                  {.hold_on_base_fault = options.hold_on_base_fault});

  Stamp next = monotonic_now();
  const auto goes_on = [&] {
    return !mission.finished() || options.session != nullptr || options.until_stopped || options.conduct;
  };
  while (goes_on() && apply(options.operator_wish(), base, options)) {
    attend(options, mission, base, recorder);
    next = std::max(next + control_period, monotonic_now());
    sleep_until(next);
    const Stamp now = monotonic_now();
    SensorInput input = sensed(now, base.poll(now), camera, options.scanner, options.depth_camera);
    if (options.session != nullptr) input.zones = options.session->take_zones();
    if (options.on_input) options.on_input(input);
    const MissionStep step = mission.step(input);
    base.command(step.navigation.command);
    if (options.on_step) options.on_step(input.now);

    watcher.see(input.base, base.warnings());
    camera_watcher.see(input, step.navigation.camera);
    recorder.take(input, step, mission);
    if (options.conduct && !options.conduct(step, mission)) break;
    if (options.attend) options.attend(input, step, mission);
    keeper.step(input.now, [&] { return mission.learned(); });
    if (options.session != nullptr) options.session->publish(input, step, mission);
    if (const std::string words = in_words(mission, step.event); !words.empty())
      options.tell(step.event == MissionEvent::goal_failed ? Severity::warning : Severity::info, words);
  }
  base.command({});
  if (options.on_end) options.on_end();
  keeper.end(mission.learned());
  return {recorder.end(mission)};
}

}  // namespace lodestar
