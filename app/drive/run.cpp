#include "app/drive/run.hpp"

#include <fmt/format.h>

#include "app/live/operator_session.hpp"
#include "app/navigation/mission.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "app/recording/picture_keeper.hpp"
#include "app/recording/run_recorder.hpp"
#include "drivers/can/recorded_bus.hpp"
#include "drivers/system/clock.hpp"

namespace lodestar {
namespace {

constexpr Duration control_period = std::chrono::milliseconds(20);

/// Reports changes of the base's state.
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
    options_.tell(fmt::format("camera: {}", words.empty() ? "frames are usable again" : words));
    said_ = words;
  }

 private:
  const RunOptions& options_;
  Stamp start_;
  bool has_seen_ = false;
  std::string said_;
};

/// At most two frames a control period; further ones wait for the next, so that catching up does not delay
/// commands.
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

/// False when the run is to end.
bool obey(OperatorWish wish, BaseDriver& base, const RunOptions& options) {
  if (wish == OperatorWish::stop) return false;
  if (wish == OperatorWish::resume && !base.resume(monotonic_now())) {
    options.tell("base: cannot resume, the cause is still there");
  }
  return true;
}

/// The record of one drive, while there is one.
class Recording {
 public:
  Recording(const Site& site, const RunOptions& options) : site_(site), options_(options) {}

  void begin(const std::vector<Goal>& goals) {
    if (on_) return;
    on_ = true;
    start_ = monotonic_now();
    record_ = {};
    record_.site = site_.name;
    record_.camera = options_.camera;
    record_.robot_radius_m = site_.robot.radius_m;
    for (const Goal& goal : goals) record_.goals.push_back({.goal = goal});
  }

  void take(const StampedCanFrame& frame) {
    if (on_) record_.can_frames.push_back(frame);
  }

  void take(const SensorInput& input, const Mission& mission, const MissionStep& step) {
    if (!on_) return;
    record_step(record_, input, step.navigation);
    const std::optional<KeptPicture> picture = pictures_.keep(record_, input.frames);
    record_event(record_, mission, step.event, input.now);
    if (options_.watch)
      options_.watch({.input = input, .step = step, .mission = mission, .picture = picture});
  }

  RunRecord end(const Mission& mission) {
    if (on_ && !mission.finished()) record_.goals[mission.current()].failure = "stopped by the operator";
    record_.wall_time_s = seconds(monotonic_now() - start_);
    on_ = false;
    return std::exchange(record_, {});
  }

  [[nodiscard]] bool is_on() const { return on_; }

 private:
  const Site& site_;
  const RunOptions& options_;
  bool on_ = false;
  Stamp start_;
  RunRecord record_;
  PictureKeeper pictures_{{.pictures_hz = options_.pictures_hz}};
};

/// Applies the orders of the operator session before a step.
void attend(const RunOptions& options, Mission& mission, BaseDriver& base, Recording& recording) {
  if (options.session == nullptr) return;
  if (recording.is_on() && mission.finished()) options.keep(recording.end(mission));
  const Stamp now = monotonic_now();
  options.session->obey(mission, base, now, now);
  if (!mission.finished()) recording.begin(mission.goals());
}

}  // namespace

RunRecord run(const Site& site, CanBus& bus, std::unique_ptr<BaseProtocol> protocol, Camera& camera,
              const RunOptions& options) {
  Recording recording(site, options);
  if (!options.goals.empty()) recording.begin(options.goals);
  RecordedBus recorded(bus, [&recording](const StampedCanFrame& frame) { recording.take(frame); });
  BaseDriver base(recorded, std::move(protocol));
  BaseWatcher watcher(options);
  CameraWatcher camera_watcher(options);
  Mission mission(known_world(site, options.camera), navigation_options(site.robot), options.goals,
                  {.hold_on_base_fault = options.hold_on_base_fault});

  Stamp next = monotonic_now();
  const auto goes_on = [&] { return !mission.finished() || options.session != nullptr; };
  while (goes_on() && obey(options.operator_wish(), base, options)) {
    attend(options, mission, base, recording);
    next = std::max(next + control_period, monotonic_now());
    sleep_until(next);
    const SensorInput input = sense(camera, base);
    const MissionStep step = mission.step(input);
    base.command(step.navigation.command);

    watcher.see(input.base);
    camera_watcher.see(input, step.navigation.camera);
    recording.take(input, mission, step);
    if (options.session != nullptr) options.session->show(input, step, mission);
    if (const std::string words = in_words(mission, step.event); !words.empty()) options.tell(words);
  }
  base.command({});
  return recording.end(mission);
}

}  // namespace lodestar
