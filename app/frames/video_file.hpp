#pragma once

#include <filesystem>
#include <optional>

#include "app/frames/frame_source.hpp"
#include "app/frames/video_decoder.hpp"

namespace lodestar {

/// The frames of a video file, of any container and codec that the program ffmpeg reads, as 8-bit gray.
/// Stamp: the frame's time in the container, which begins near zero; a rate that varies is kept.
class VideoFile final : public FrameSource {
 public:
  /// Throws InputError when it is not a video, or when there is no ffmpeg.
  explicit VideoFile(std::filesystem::path file);

  /// A truncated video ends there, with a message on stderr when many frames are missing. Throws InputError
  /// when not even the first frame can be decoded.
  std::optional<SourceFrame> next() override;

 private:
  void at_the_end() const;

  std::filesystem::path file_;
  VideoFacts facts_;
  std::optional<VideoDecoder> video_;
  int frame_ = 0;
};

}  // namespace lodestar
