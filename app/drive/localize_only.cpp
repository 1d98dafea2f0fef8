#include "app/drive/localize_only.hpp"

#include <fmt/format.h>

#include "app/drive/sensing.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "drivers/system/clock.hpp"

namespace lodestar {
namespace {

std::string in_words(const Pose2& at) {
  return fmt::format("({:.2f}, {:.2f}, {:.0f} deg)", at.position_m.x(), at.position_m.y(),
                     degrees(at.yaw_rad));
}

}  // namespace

void localize_only(const Site& site, Camera& camera, const LocalizeOnlyOptions& options) {
  constexpr Duration period = std::chrono::milliseconds(20);
  Mission mission(known_world(site, options.camera), navigation_options(site.robot), {});
  std::optional<PoseEstimate> newest;
  Stamp next = monotonic_now();
  while (options.operator_wish() != OperatorWish::stop) {
    next = std::max(next + period, monotonic_now());
    sleep_until(next);
    const Stamp now = monotonic_now();
    const SensorInput input =
        sensed(now, options.feedback(now), camera, options.scanner, options.depth_camera);
    const MissionStep step = mission.step(input);
    if (options.attend) options.attend(input, step, mission);
    if (options.on_step) options.on_step(now);
    if (step.navigation.estimate && !newest)
      options.tell(Severity::info, "the robot is at " + in_words(step.navigation.estimate->map_from_base));
    newest = step.navigation.estimate;
  }
  if (newest) options.tell(Severity::info, "at the end the robot is at " + in_words(newest->map_from_base));
}

}  // namespace lodestar
