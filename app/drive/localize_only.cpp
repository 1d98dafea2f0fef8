#include "app/drive/localize_only.hpp"

#include <fmt/format.h>

#include "app/drive/sensing.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "drivers/system/clock.hpp"

namespace lodestar {

void localize_only(const Site& site, Camera& camera, const LocalizeOnlyOptions& options) {
  constexpr Duration period = std::chrono::milliseconds(20);
  Mission mission(known_world(site, options.camera), navigation_options(site.robot), {});
  bool knew = false;
  Stamp next = monotonic_now();
  while (options.operator_wish() != OperatorWish::stop) {
    next = std::max(next + period, monotonic_now());
    sleep_until(next);
    const Stamp now = monotonic_now();
    const SensorInput input = sensed(now, options.feedback(now), camera, options.scanner);
    const MissionStep step = mission.step(input);
    if (options.attend) options.attend(input, step, mission);
    if (options.on_step) options.on_step(now);
    const bool knows = step.navigation.estimate.has_value();
    if (knows && !knew) {
      const Pose2& at = step.navigation.estimate->map_from_base;
      options.tell(Severity::info, fmt::format("the robot is at ({:.2f}, {:.2f}, {:.0f} deg)",
                                               at.position_m.x(), at.position_m.y(), degrees(at.yaw_rad)));
    }
    knew = knows;
  }
}

}  // namespace lodestar
