#include "app/drive/camera_setup.hpp"

#include "app/frames/video_camera.hpp"
#include "drivers/camera/pluggable_camera.hpp"
#include "drivers/camera/v4l2_depth_camera.hpp"
#include "drivers/scanner/scanner_driver.hpp"
#include "drivers/stand_in/camera_stand_in.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

V4l2CameraOptions v4l2_options(const CameraModel& model, const CameraSettings& settings) {
  V4l2CameraOptions options{.width_px = model.width_px, .height_px = model.height_px};
  if (settings.exposure_s) options.exposure = from_seconds(*settings.exposure_s);
  if (settings.gain) options.gain = static_cast<int>(*settings.gain);
  options.rate_hz = settings.rate_hz;
  options.latency = from_seconds(settings.latency_s);
  if (settings.stamped_at_start)
    options.stamped_at = *settings.stamped_at_start ? StampedAt::exposure_start : StampedAt::arrival;
  return options;
}

GenicamCameraOptions genicam_options(const CameraModel& model, const CameraSettings& settings) {
  GenicamCameraOptions options{.width_px = model.width_px, .height_px = model.height_px};
  if (settings.exposure_s) options.exposure = from_seconds(*settings.exposure_s);
  options.gain = settings.gain;
  options.rate_hz = settings.rate_hz;
  options.latency = from_seconds(settings.latency_s);
  return options;
}

}  // namespace

std::unique_ptr<Camera> open_camera(const Site& site, const BaseConnection& base, std::uint64_t seed) {
  const CameraModel& model = site.cameras.at(site.default_camera);
  const std::string device = "v4l2:";
  const std::string machine_vision = "genicam:";
  const std::string video = "video:";
  if (site.camera == "simulated") {
    return open_camera_stand_in(base.interface, site.registry, model, site.robot.base_from_camera, seed);
  }
  if (site.camera.starts_with(device)) {
    return open_v4l2_camera(site.camera.substr(device.size()), v4l2_options(model, site.camera_settings));
  }
  if (site.camera.starts_with(machine_vision)) {
    return open_genicam_camera(site.camera.substr(machine_vision.size()),
                               genicam_options(model, site.camera_settings));
  }
  if (site.camera.starts_with(video)) {
    return std::make_unique<VideoCamera>(site.folder / site.camera.substr(video.size()));
  }
  throw InputError(site.folder / "site.yaml", 0,
                   site.camera.empty() ? "no key camera" : "camera: '" + site.camera + "'",
                   "camera: v4l2:/dev/video0, genicam: and its ID, video: and a file, or simulated");
}

std::unique_ptr<Scanner> scanner_of(const Site& site) {
  if (!site.robot.scanner) return nullptr;
  if (site.scanner.empty())
    throw InputError(site.folder / "site.yaml", 0, "no scanner, but a robot that has one",
                     "scanner: with its address, such as ld19:/dev/ttyUSB0");
  return open_scanner(site.scanner);
}

std::unique_ptr<DepthCamera> depth_camera_of(const Site& site) {
  if (!site.robot.depth_camera) return nullptr;
  const std::string device = "v4l2:";
  if (!site.depth_camera.starts_with(device))
    throw InputError(site.folder / "site.yaml", 0,
                     site.depth_camera.empty() ? "no depth_camera, but a robot that has one"
                                               : "depth_camera: '" + site.depth_camera + "'",
                     "depth_camera: v4l2:/dev/video2");
  const CameraModel& camera = site.robot.depth_camera->mount.camera;
  return open_v4l2_depth_camera(site.depth_camera.substr(device.size()), camera.width_px, camera.height_px);
}

}  // namespace lodestar
