#include "app/frames/video_decoder.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <poll.h>
#include <sstream>
#include <unistd.h>
#include <utility>

namespace lodestar {
namespace {

namespace fs = std::filesystem;

/// No other protocols: a playlist could name other hosts.
const std::vector<std::string> quiet{"-v", "quiet", "-protocol_whitelist", "file,pipe"};

/// With the protocol, as a name may have a colon.
std::string address_of(const fs::path& file) {
  return "file:" + fs::absolute(file).string();
}

std::vector<std::string> probing(const fs::path& file) {
  std::vector<std::string> words{"ffprobe"};
  words.insert(words.end(), quiet.begin(), quiet.end());
  words.insert(words.end(),
               {"-select_streams", "v:0", "-show_entries", "stream=nb_frames,avg_frame_rate:format=duration",
                "-of", "default=noprint_wrappers=1", address_of(file)});
  return words;
}

/// The pictures as PGM images, which say their size, and each one's time as a line of framecrc.
std::vector<std::string> decoding(const fs::path& file) {
  std::vector<std::string> words{"ffmpeg", "-nostdin"};
  words.insert(words.end(), quiet.begin(), quiet.end());
  words.insert(words.end(), {"-i", address_of(file)});
  words.insert(words.end(), {"-map", "0:v:0", "-fps_mode", "passthrough", "-pix_fmt", "gray", "-c:v", "pgm",
                             "-f", "image2pipe", "pipe:1"});
  words.insert(words.end(), {"-map", "0:v:0", "-fps_mode", "passthrough", "-c:v", "wrapped_avframe", "-f",
                             "framecrc", "pipe:3"});
  return words;
}

/// Appends what can be read at once. False at the end.
bool append_from(int descriptor, std::string& to) {
  std::array<char, 65536> chunk{};
  const ssize_t count = ::read(descriptor, chunk.data(), chunk.size());
  if (count < 0) return errno == EINTR;
  to.append(chunk.data(), static_cast<std::size_t>(count));
  return count > 0;
}

}  // namespace

std::optional<VideoFacts> video_facts(const fs::path& file) {
  const PipedProgram ffprobe(probing(file));
  std::istringstream lines(read_to_end(ffprobe.output()));
  VideoFacts facts;
  double rate_hz = 0.0;
  double duration_s = 0.0;
  bool has_video = false;
  for (std::string line; std::getline(lines, line);) {
    double value = 0.0;
    double divisor = 0.0;
    if (std::sscanf(line.c_str(), "avg_frame_rate=%lf/%lf", &value, &divisor) == 2) {
      has_video = true;
      rate_hz = divisor > 0.0 ? value / divisor : 0.0;
    }
    if (std::sscanf(line.c_str(), "nb_frames=%lf", &value) == 1) facts.frames = value;
    if (std::sscanf(line.c_str(), "duration=%lf", &value) == 1) duration_s = value;
  }
  if (!has_video) return std::nullopt;
  if (!facts.frames && rate_hz * duration_s > 0.0) facts.frames = rate_hz * duration_s;
  return facts;
}

VideoDecoder::VideoDecoder(const fs::path& file) : ffmpeg_(decoding(file)) {}

std::optional<VideoDecoder::Picture> VideoDecoder::next() {
  std::optional<double> time_s;
  std::optional<cv::Mat> gray;
  for (;;) {
    if (!time_s) time_s = take_time();
    if (!gray) gray = take_picture();
    if (time_s && gray) return Picture{.gray = std::move(*gray), .time_s = *time_s};
    if (!read_more()) return std::nullopt;
  }
}

/// From whichever pipe has something: ffmpeg would wait for ever for a full one that nobody reads.
bool VideoDecoder::read_more() {
  if (pictures_ended_ && times_ended_) return false;
  constexpr int nothing = -1;  // poll() passes it over
  std::array<pollfd, 2> pipes{
      {{.fd = pictures_ended_ ? nothing : ffmpeg_.output(), .events = POLLIN, .revents = 0},
       {.fd = times_ended_ ? nothing : ffmpeg_.third(), .events = POLLIN, .revents = 0}}};
  if (::poll(pipes.data(), pipes.size(), -1) < 0) return errno == EINTR;
  if (pipes[0].revents != 0) pictures_ended_ = !append_from(ffmpeg_.output(), pictures_);
  if (pipes[1].revents != 0) times_ended_ = !append_from(ffmpeg_.third(), times_);
  return true;
}

/// A line after those of the header, which begin with #: stream, decoding time, presentation time, ...
std::optional<double> VideoDecoder::take_time() {
  for (std::size_t end = times_.find('\n'); end != std::string::npos; end = times_.find('\n')) {
    const std::string line = times_.substr(0, end);
    times_.erase(0, end + 1);
    long ticks = 0;
    double numerator = 0.0;
    double denominator = 1.0;
    if (std::sscanf(line.c_str(), "#tb 0: %lf/%lf", &numerator, &denominator) == 2)
      tick_s_ = numerator / denominator;
    if (std::sscanf(line.c_str(), "%*d,%*d,%ld", &ticks) == 1) return tick_s_ * static_cast<double>(ticks);
  }
  return std::nullopt;
}

std::optional<cv::Mat> VideoDecoder::take_picture() {
  int width_px = 0;
  int height_px = 0;
  int header = 0;
  constexpr std::size_t longest_header = 32;
  const std::string begin = pictures_.substr(0, longest_header);
  if (std::sscanf(begin.c_str(), "P5\n%d %d\n255%n", &width_px, &height_px, &header) != 2 || header == 0)
    return std::nullopt;
  const std::size_t at = static_cast<std::size_t>(header) + 1;
  const std::size_t size = static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  if (pictures_.size() < at + size) return std::nullopt;
  const cv::Mat seen(height_px, width_px, CV_8UC1, pictures_.data() + at);
  cv::Mat gray = seen.clone();
  pictures_.erase(0, at + size);
  return gray;
}

}  // namespace lodestar
