#pragma once

#include <filesystem>
#include <functional>

#include "app/frames/video_file.hpp"
#include "drivers/camera/camera.hpp"
#include "drivers/system/clock.hpp"

namespace lodestar {

/// A recorded video in place of a camera: its frames arrive at the recorded rate, from the first poll on,
/// stamped with their time of arrival. Nothing arrives after its end.
class VideoCamera final : public Camera {
 public:
  /// Throws InputError when it is not a video.
  explicit VideoCamera(std::filesystem::path file, std::function<Stamp()> now = monotonic_now);

  std::optional<Frame> poll() override;

 private:
  VideoFile video_;
  std::function<Stamp()> now_;
  std::optional<SourceFrame> next_;
  std::optional<Duration> now_from_video_;  ///< offset to add to the video's own stamps
};

}  // namespace lodestar
