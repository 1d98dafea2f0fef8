#include "app/frames/live_camera.hpp"

#include <fmt/format.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

V4l2CameraOptions options_for(const std::optional<CameraModel>& camera) {
  V4l2CameraOptions options;
  if (camera) {
    options.width_px = camera->width_px;
    options.height_px = camera->height_px;
  }
  return options;
}

}  // namespace

LiveCamera::LiveCamera(const std::filesystem::path& device, const std::optional<CameraModel>& camera)
    : file_(device), device_(open_video_device(device), device.string(), options_for(camera)) {}

std::optional<SourceFrame> LiveCamera::next() {
  constexpr Duration patience = std::chrono::milliseconds(100);
  constexpr int silent_for = 50;  // 5 s: well above slow exposures and slow camera start-up
  for (int waited = 0; waited <= silent_for; ++waited) {
    if (Interruption::asked()) return std::nullopt;
    if (std::optional<Frame> frame = device_.poll()) {
      const int number = frame_++;
      return SourceFrame{.name = fmt::format("{}#{}", file_.string(), number),
                         .picture = fmt::format("{}-{:06}", file_.filename().string(), number),
                         .of_sequence = true,
                         .stamp = frame->stamp,
                         .gray = std::move(frame->gray)};
    }
    if (device_.lost()) throw InputError(file_, 0, "a camera that is gone", "one that stays plugged in");
    device_.wait(patience);
  }
  throw InputError(file_, 0, "no frame in 5 s", "a camera that sends frames");
}

}  // namespace lodestar
