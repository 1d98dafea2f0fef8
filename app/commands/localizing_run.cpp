#include "app/commands/localizing_run.hpp"

#include <memory>
#include <optional>

#include "app/common/interruption.hpp"
#include "app/common/log.hpp"
#include "app/drive/camera_setup.hpp"
#include "app/drive/localize_only.hpp"
#include "app/site/base_setup.hpp"
#include "drivers/base/listened_base.hpp"
#include "drivers/can/socketcan_bus.hpp"
#include "drivers/system/service_manager.hpp"

namespace lodestar {
namespace {

/// The robot of another program, by its topic odom.
class OdometryOfRos {
 public:
  explicit OdometryOfRos(Ros2Session& session) : session_(session) {}

  BaseFeedback poll(Stamp now) {
    constexpr Duration most_age = std::chrono::milliseconds(300);  // some periods of 20 to 50 ms
    BaseFeedback feedback{.travel = session_.wheel_travel()};
    if (!feedback.travel.empty()) last_heard_ = now;
    feedback.last_heard = last_heard_;
    const bool is_there = last_heard_ && now - *last_heard_ <= most_age;
    feedback.state = is_there ? BaseState::ready : BaseState::waiting_for_base;
    if (!is_there) feedback.fault = BaseFault::feedback_lost;
    return feedback;
  }

 private:
  Ros2Session& session_;
  std::optional<Stamp> last_heard_;
};

}  // namespace

ExitCode run_localizing(const Site& site, const LocalizingRun& how, std::function<OperatorWish()> wish) {
  BaseConnection connection{.interface = how.interface};
  const bool needs_base = !how.reads_odometry || site.camera == "simulated";
  if (needs_base) connection = connection_of(site, how.interface);
  Ros2Options options = ros2_options(how.ros2, false);
  options.reads_odometry = how.reads_odometry;
  options.publishes_odometry = !how.reads_odometry;
  const std::unique_ptr<Camera> camera = open_camera(site, connection, how.seed);
  const std::unique_ptr<Scanner> scanner = scanner_of(site);
  const std::unique_ptr<DepthCamera> depth_camera = depth_camera_of(site);
  const Interruption interruption;
  ServiceManager manager(service_environment());
  Ros2Service ros2(site, options);
  LocalizeOnlyOptions localize{
      .camera = site.default_camera,
      .feedback = {},
      .operator_wish = std::move(wish),
      .tell = [](Severity severity, const std::string& words) { program_log().say(severity, words); },
      .on_step = [&manager](Stamp now) { manager.step(now); },
      .scanner = scanner.get(),
      .depth_camera = depth_camera.get(),
      .attend = [&ros2](const SensorInput& input, const MissionStep& step,
                        Mission& mission) { ros2.session().attend(input, step, mission); }};
  std::optional<SocketCanBus> bus;
  std::optional<ListenedBase> base;
  OdometryOfRos odometry(ros2.session());
  if (how.reads_odometry) {
    localize.feedback = [&odometry](Stamp now) { return odometry.poll(now); };
  } else {
    base.emplace(bus.emplace(connection.interface), make_protocol(connection, site.robot));
    localize.feedback = [&base](Stamp now) { return base->poll(now); };
  }
  localize_only(site, *camera, localize);
  manager.stop();
  return done;
}

}  // namespace lodestar
