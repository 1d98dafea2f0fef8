#pragma once

#include <functional>
#include <future>
#include <memory>

#include "drivers/camera/device_camera.hpp"
#include "drivers/camera/genicam_camera.hpp"
#include "drivers/camera/v4l2_camera.hpp"
#include "drivers/system/clock.hpp"

namespace lodestar {

struct PluggableCameraOptions {
  Duration retry_period = std::chrono::seconds(1);  ///< between two attempts to reopen it
  Duration max_silence = std::chrono::seconds(2);   ///< after which a connected camera is reopened
  std::function<Stamp()> now = monotonic_now;
};

/// A camera that may be unplugged, hang, and come back: it is reopened automatically, in another thread,
/// since opening a USB camera takes longer than a moving robot may go without commands.
class PluggableCamera final : public Camera {
 public:
  using Open = std::function<std::unique_ptr<DeviceCamera>()>;

  /// Opens it for the first time. Throws InputError when that fails: a camera that is missing at the start is
  /// a configuration error, one that disappears later is a fault.
  explicit PluggableCamera(Open open, PluggableCameraOptions options = {});

  std::optional<Frame> poll() override;
  [[nodiscard]] std::string description() const override;

 private:
  void open_again();
  void take_opened();

  Open open_;
  PluggableCameraOptions options_;
  std::unique_ptr<DeviceCamera> camera_;
  Stamp heard_;  ///< arrival of the newest frame, or time of the last attempt to open
  std::future<std::unique_ptr<DeviceCamera>> opening_;
};

/// The camera at the given device node (`/dev/video0`). The options apply at every opening, also after it was
/// unplugged.
std::unique_ptr<Camera> open_v4l2_camera(const std::string& device, const V4l2CameraOptions& options);

/// The same of a machine-vision camera: see GenicamCamera.
std::unique_ptr<Camera> open_genicam_camera(const std::string& id, const GenicamCameraOptions& options);

}  // namespace lodestar
