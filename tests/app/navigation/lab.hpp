#pragma once

#include <filesystem>
#include <functional>
#include <opencv2/imgproc.hpp>

#include "app/navigation/navigation.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "app/simulate/disturbances.hpp"
#include "drivers/base/base_driver.hpp"
#include "drivers/simulation/simulation.hpp"

namespace lodestar {

inline constexpr Duration period = std::chrono::milliseconds(20);

inline Site lab() {
  return load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
}

/// The lab as it really is, with a robot that knows it as surveyed.
struct Lab {
  Site site = lab();
  KnownWorld known = known_world(site, "wide");
  MarkerRegistry installed = site.registry;  ///< the actual ceiling
  std::uint64_t seed = 1;
  Disturbances disturbances;
  bool has_plain_ceiling = false;                                ///< only markers are visible on it
  std::function<bool(Stamp)> sees = [](Stamp) { return true; };  ///< false: the lens is covered

  [[nodiscard]] Simulation simulation() const {
    SimulationOptions options;
    options.start = site.start;
    options.base_from_camera = site.robot.base_from_camera;
    options.robot_radius_m = site.robot.radius_m;
    options.base.track_width_m = site.robot.track_width_m;
    options.seed = seed;
    return {known.map, installed, known.camera, with_disturbances(options, disturbances)};
  }
};

inline SensorInput sense(const Lab& lab, Simulation& simulation, BaseDriver& base) {
  simulation.advance(period);
  SensorInput input{.now = simulation.now(), .frames = {}, .base = base.poll(simulation.now())};
  while (std::optional<Frame> frame = simulation.camera().poll()) {
    if (!lab.sees(frame->stamp)) cv::blur(frame->gray, frame->gray, {101, 101});
    input.frames.push_back(std::move(*frame));
  }
  return input;
}

}  // namespace lodestar
