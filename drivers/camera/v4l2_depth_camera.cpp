#include "drivers/camera/v4l2_depth_camera.hpp"

#include <utility>

#include "drivers/camera/pluggable_camera.hpp"

namespace lodestar {
namespace {

class V4l2DepthCamera final : public DepthCamera {
 public:
  explicit V4l2DepthCamera(std::unique_ptr<Camera> camera) : camera_(std::move(camera)) {}

  std::optional<DepthImage> poll() override {
    std::optional<Frame> frame = camera_->poll();
    if (!frame) return std::nullopt;
    return DepthImage{.stamp = frame->stamp, .depth_mm = std::move(frame->gray)};
  }

  [[nodiscard]] std::string description() const override { return camera_->description(); }

 private:
  std::unique_ptr<Camera> camera_;
};

}  // namespace

std::unique_ptr<DepthCamera> open_v4l2_depth_camera(const std::string& device, int width_px, int height_px) {
  V4l2CameraOptions options{.width_px = width_px, .height_px = height_px};
  options.depth = true;
  return std::make_unique<V4l2DepthCamera>(open_v4l2_camera(device, options));
}

}  // namespace lodestar
