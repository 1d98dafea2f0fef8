#include "app/frames/video_file.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fstream>
#include <system_error>

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
  try {
    const std::optional<VideoFacts> facts = video_facts(file_);
    if (!facts) refuse(file_);
    facts_ = *facts;
    video_.emplace(file_);
  } catch (const std::system_error& error) {
    throw InputError(file_, 0, fmt::format("{}, to read a video with", error.what()),
                     "ffmpeg: apt install ffmpeg");
  }
}

std::optional<SourceFrame> VideoFile::next() {
  std::optional<VideoDecoder::Picture> picture = video_->next();
  if (!picture) {
    if (frame_ == 0) refuse(file_);
    at_the_end();
    return std::nullopt;
  }
  const int number = frame_++;
  return SourceFrame{.name = fmt::format("{}#{}", file_.string(), number),
                     .picture = fmt::format("{}-{:06}", file_.stem().string(), number),
                     .of_sequence = true,
                     .stamp = Stamp(from_seconds(std::max(picture->time_s, 0.0))),
                     .gray = std::move(picture->gray)};
}

/// Containers give the number of frames only roughly, so only a large gap is reported.
void VideoFile::at_the_end() const {
  constexpr double rough = 0.9;
  if (!facts_.frames || frame_ + 1 >= rough * *facts_.frames) return;
  fmt::print(stderr, "{}: ends after {} of about {:.0f} frames\n", file_.string(), frame_, *facts_.frames);
}

}  // namespace lodestar
