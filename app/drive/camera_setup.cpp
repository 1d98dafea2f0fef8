#include "app/drive/camera_setup.hpp"

#include "app/frames/video_camera.hpp"
#include "drivers/camera/pluggable_camera.hpp"
#include "drivers/stand_in/camera_stand_in.hpp"
#include "maps/input_error.hpp"

namespace lodestar {

std::unique_ptr<Camera> open_camera(const Site& site, const BaseConnection& base, std::uint64_t seed) {
  const CameraModel& model = site.cameras.at(site.default_camera);
  const std::string device = "v4l2:";
  const std::string video = "video:";
  if (site.camera == "simulated") {
    return open_camera_stand_in(base.interface, site.registry, model, site.robot.base_from_camera, seed);
  }
  if (site.camera.starts_with(device)) {
    return open_v4l2_camera(site.camera.substr(device.size()), model.width_px, model.height_px);
  }
  if (site.camera.starts_with(video)) {
    return std::make_unique<VideoCamera>(site.folder / site.camera.substr(video.size()));
  }
  throw InputError(site.folder / "site.yaml", 0,
                   site.camera.empty() ? "no key camera" : "camera: '" + site.camera + "'",
                   "camera: v4l2:/dev/video0, video: and a file, or simulated");
}

}  // namespace lodestar
