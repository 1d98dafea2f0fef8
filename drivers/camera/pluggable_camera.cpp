#include "drivers/camera/pluggable_camera.hpp"

#include "maps/input_error.hpp"

namespace lodestar {

PluggableCamera::PluggableCamera(Open open, PluggableCameraOptions options)
    : open_(std::move(open)), options_(std::move(options)), camera_(open_()), heard_(options_.now()) {}

std::optional<Frame> PluggableCamera::poll() {
  take_opened();
  std::optional<Frame> frame = camera_ ? camera_->poll() : std::nullopt;
  const Stamp now = options_.now();
  if (frame) heard_ = now;
  const bool is_gone = !camera_ || camera_->lost();
  const Duration patience = is_gone ? options_.retry_period : options_.max_silence;
  if (!frame && !opening_.valid() && now - heard_ >= patience) open_again();
  return frame;
}

/// Closes the old device first: while its node is open, the camera that comes back gets another name.
void PluggableCamera::open_again() {
  heard_ = options_.now();
  opening_ =
      std::async(std::launch::async, [open = open_, gone = std::shared_ptr(std::move(camera_))]() mutable {
        gone.reset();
        try {
          return open();
        } catch (const InputError&) {
          return std::unique_ptr<DeviceCamera>();  // not yet
        }
      });
}

void PluggableCamera::take_opened() {
  if (!opening_.valid() || opening_.wait_for(Duration::zero()) != std::future_status::ready) return;
  camera_ = opening_.get();
  heard_ = options_.now();
}

std::string PluggableCamera::description() const {
  return camera_ ? camera_->description() : std::string();
}

std::unique_ptr<Camera> open_v4l2_camera(const std::string& device, const V4l2CameraOptions& options) {
  return std::make_unique<PluggableCamera>(
      [device, options] { return std::make_unique<V4l2Camera>(open_video_device(device), device, options); });
}

std::unique_ptr<Camera> open_genicam_camera(const std::string& id, const GenicamCameraOptions& options) {
  return std::make_unique<PluggableCamera>(
      [id, options] { return std::make_unique<GenicamCamera>(id, options); });
}

}  // namespace lodestar
