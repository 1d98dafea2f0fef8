#include "app/frames/video_file.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fstream>
#include <opencv2/imgproc.hpp>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file) {
  throw InputError(file, 0, "no image and no video that can be decoded",
                   "an image, a video, a folder of images or a camera device");
}

/// FFmpeg also renders text as a video and follows playlists to other files and hosts; both are refused.
/// Every video has a zero byte among its first 1024.
bool is_text(const fs::path& file) {
  std::array<char, 1024> head{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  const auto end = head.begin() + stream.gcount();
  return std::find(head.begin(), end, '\0') == end;
}

}  // namespace

VideoFile::VideoFile(fs::path file) : file_(std::move(file)) {
  if (is_text(file_)) refuse(file_);
  // Of OpenCV's backends only FFmpeg's CAP_PROP_POS_MSEC is the time of the frame just grabbed.
  if (!video_.open(file_.string(), cv::CAP_FFMPEG)) refuse(file_);
}

std::optional<SourceFrame> VideoFile::next() {
  if (!video_.read(color_) || color_.empty()) {
    if (frame_ == 0) refuse(file_);
    at_the_end();
    return std::nullopt;
  }
  cv::Mat gray;
  cv::cvtColor(color_, gray, cv::COLOR_BGR2GRAY);  // FFmpeg's reader gives BGR whatever the video holds
  constexpr double ms_per_s = 1000.0;
  const double stamp_s = std::max(video_.get(cv::CAP_PROP_POS_MSEC), 0.0) / ms_per_s;
  const int number = frame_++;
  return SourceFrame{.name = fmt::format("{}#{}", file_.string(), number),
                     .picture = fmt::format("{}-{:06}", file_.stem().string(), number),
                     .stamp = Stamp(from_seconds(stamp_s)),
                     .gray = std::move(gray)};
}

/// Containers give the number of frames only roughly, so only a large gap is reported.
void VideoFile::at_the_end() const {
  constexpr double rough = 0.9;
  const double expected = video_.get(cv::CAP_PROP_FRAME_COUNT);
  if (frame_ + 1 < rough * expected) {
    fmt::print(stderr, "{}: ends after {} of about {:.0f} frames\n", file_.string(), frame_, expected);
  }
}

}  // namespace lodestar
