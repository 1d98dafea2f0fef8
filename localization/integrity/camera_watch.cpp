#include "localization/integrity/camera_watch.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "maps/percentile.hpp"

namespace lodestar {
namespace {

/// Summary of some rows of an image.
struct Sample {
  std::uint64_t hash = 0;
  int darkest = 255;
  int brightest = 0;
};

/// Every sixteenth row, eight pixels at a time (xor, multiply and xor-shift: FNV-1a with wider words).
Sample sample_of(const cv::Mat& gray) {
  constexpr int row_step = 16;
  constexpr std::uint64_t prime = 0x9e3779b97f4a7c15ULL;
  Sample sample;
  for (int v = row_step / 2; v < gray.rows; v += row_step) {
    const auto* row = gray.ptr<std::uint8_t>(v);
    const auto [darkest, brightest] = std::minmax_element(row, row + gray.cols);
    sample.darkest = std::min<int>(sample.darkest, *darkest);
    sample.brightest = std::max<int>(sample.brightest, *brightest);
    for (int u = 0; u + 8 <= gray.cols; u += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, row + u, sizeof word);
      sample.hash = (sample.hash ^ word) * prime;
      sample.hash ^= sample.hash >> 29U;
    }
  }
  return sample;
}

}  // namespace

std::string_view to_string(CameraFault fault) {
  switch (fault) {
    case CameraFault::silent:
      return "the camera sends no frames";
    case CameraFault::repeats:
      return "the camera repeats the same picture";
    case CameraFault::dark:
      return "the camera sees nothing but black";
    case CameraFault::bright:
      return "the camera sees nothing but white";
    case CameraFault::late:
      return "the camera's frames come too late";
    case CameraFault::other_clock:
      return "the camera's clock is not the robot's";
  }
  return "";
}

std::optional<CameraFault> CameraWatch::update(const Frame& frame, Stamp now) {
  const Sample sample = sample_of(frame.gray);
  const bool is_white = sample.darkest > options_.bright_gray;
  const bool is_same = last_picture_ == sample.hash && !is_white;
  last_picture_ = sample.hash;
  last_arrival_ = now;
  learn_pace(frame.stamp);

  const Duration age = now - frame.stamp;
  fault_.reset();
  if (age < -options_.max_ahead || age > options_.another_age) {
    fault_ = CameraFault::other_clock;
  } else if (age > options_.max_age) {
    fault_ = CameraFault::late;
  } else if (is_same) {
    fault_ = CameraFault::repeats;
  }
  if (fault_) return fault_;
  if (is_white) fault_ = CameraFault::bright;
  if (sample.brightest < options_.dark_gray) fault_ = CameraFault::dark;
  return std::nullopt;
}

std::optional<CameraFault> CameraWatch::fault(Stamp now) const {
  if (last_arrival_ && now - *last_arrival_ > silence_to_miss()) return CameraFault::silent;
  return fault_;
}

/// Averages over the last fifty frames. The period is the lower quartile of the intervals: a camera that
/// loses up to three frames of four still shows it, and a single short interval, as from a driver that
/// catches up, does not. A long silence counts as no more than `longest_silence`; stamps that do not ascend
/// are ignored.
void CameraWatch::learn_pace(Stamp captured) {
  constexpr std::size_t frames = 50;
  constexpr double share_of_newest = 1.0 / frames;
  const std::optional<Stamp> before = std::exchange(last_capture_, captured);
  if (!before || captured <= *before) return;
  const double apart_s = seconds(std::min<Duration>(captured - *before, options_.longest_silence));
  intervals_s_.push_back(apart_s);
  if (intervals_s_.size() > frames) intervals_s_.pop_front();
  period_s_ = percentile({intervals_s_.begin(), intervals_s_.end()}, 0.25).value();
  pace_s_ = pace_s_ > 0.0 ? std::lerp(pace_s_, apart_s, share_of_newest) : apart_s;
}

/// A camera that loses the share p of its frames loses k in a row once in p^-k frames.
Duration CameraWatch::silence_to_miss() const {
  const Duration least = std::max<Duration>(options_.max_silence, from_seconds(3.0 * period_s_));
  if (!(pace_s_ > period_s_)) return least;
  const double lost = 1.0 - period_s_ / pace_s_;
  const double in_a_row = std::ceil(-std::log(options_.frames_to_a_false_alarm) / std::log(lost));
  const double wanted_s = std::min(in_a_row * period_s_, seconds(options_.longest_silence));
  return std::max<Duration>(from_seconds(wanted_s), least);
}

}  // namespace lodestar
