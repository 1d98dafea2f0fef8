#pragma once

#include <filesystem>
#include <opencv2/videoio.hpp>

#include "app/frames/frame_source.hpp"

namespace lodestar {

/// The frames of a video file, of any container and codec that FFmpeg reads, as 8-bit gray. Stamp: the
/// frame's time in the container, which begins near zero; a rate that varies is kept.
class VideoFile final : public FrameSource {
 public:
  /// Throws InputError when it is not a video.
  explicit VideoFile(std::filesystem::path file);

  /// A truncated video ends there, with a message on stderr when many frames are missing. Throws InputError
  /// when not even the first frame can be decoded.
  std::optional<SourceFrame> next() override;

 private:
  void at_the_end() const;

  std::filesystem::path file_;
  cv::VideoCapture video_;
  cv::Mat color_;
  int frame_ = 0;
};

}  // namespace lodestar
