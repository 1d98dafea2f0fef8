#include "app/frames/camera_setup.hpp"

#include "drivers/camera_stand_in.hpp"
#include "maps/input_error.hpp"

namespace lodestar {

std::unique_ptr<Camera> open_camera(const Site& site, const BaseConnection& base, std::uint64_t seed) {
  if (site.camera == "simulated") {
    return open_camera_stand_in(base.interface, site.registry, site.cameras.at(site.default_camera),
                                site.robot.base_from_camera, seed);
  }
  throw InputError(site.folder / "site.yaml", 0, "camera: '" + site.camera + "'", "camera: simulated");
}

}  // namespace lodestar
