#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>

#include "app/frames/piped_program.hpp"

namespace lodestar {

/// What a container says of its video, roughly.
struct VideoFacts {
  std::optional<double> frames;
};

/// By ffprobe. Nothing when the file holds no video. Throws std::system_error where there is no ffprobe.
std::optional<VideoFacts> video_facts(const std::filesystem::path& file);

/// The frames of a video by the program ffmpeg: what a stranger's video does to its decoders happens in
/// another process, and who never reads one needs none of ffmpeg's ninety packages.
class VideoDecoder {
 public:
  struct Picture {
    cv::Mat gray;         ///< 8 bits: the luma, its range widened to 0 to 255
    double time_s = 0.0;  ///< in the container, whose first frame is near zero
  };

  /// Throws std::system_error where there is no ffmpeg.
  explicit VideoDecoder(const std::filesystem::path& file);

  /// Nothing at the end, or where nothing more can be decoded.
  std::optional<Picture> next();

 private:
  [[nodiscard]] bool read_more();
  [[nodiscard]] std::optional<double> take_time();
  [[nodiscard]] std::optional<cv::Mat> take_picture();

  PipedProgram ffmpeg_;
  std::string pictures_;  ///< PGM images, the first from its beginning
  std::string times_;     ///< lines of ffmpeg's framecrc
  bool pictures_ended_ = false;
  bool times_ended_ = false;
  double tick_s_ = 0.0;
};

}  // namespace lodestar
