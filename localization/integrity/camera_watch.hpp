#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "maps/frame.hpp"

namespace lodestar {

/// Why the camera tells nothing.
enum class CameraFault {
  silent,       ///< no frame has come for several periods
  repeats,      ///< the same picture again: no two exposures have equal noise
  dark,         ///< nothing but black
  bright,       ///< nothing but white
  late,         ///< frames come long after their exposure
  other_clock,  ///< frames are stamped in the future or in another age
};

// In words for people.
std::string_view to_string(CameraFault fault);

struct CameraWatchOptions {
  /// Without any frame, usable or not: so long at least, and three of the camera's periods; and longer where
  /// frames are lost now and then, that a silence is due to chance once in so many frames, up to the last.
  Duration max_silence = std::chrono::milliseconds(150);
  double frames_to_a_false_alarm = 1e5;
  Duration longest_silence = std::chrono::milliseconds(500);
  Duration max_age = std::chrono::milliseconds(250);   ///< of a frame on arrival, since mid-exposure
  Duration max_ahead = std::chrono::milliseconds(20);  ///< of the stamp before the arrival
  Duration another_age = std::chrono::seconds(5);      ///< no camera is so late; its clock is another one
  int dark_gray = 20;     ///< a picture whose brightest sampled pixel is darker shows nothing
  int bright_gray = 240;  ///< and one whose darkest is brighter
};

/// Tells frames that can be used from those that must not be, or cannot. A value type.
class CameraWatch {
 public:
  explicit CameraWatch(const CameraWatchOptions& options = {}) : options_(options) {}

  /// What is wrong with a frame that has just arrived; nothing when it can be used. Dark and bright ones can,
  /// for what they are worth.
  std::optional<CameraFault> update(const Frame& frame, Stamp now);

  /// What is wrong with the camera now. It is not missed before its first frame.
  [[nodiscard]] std::optional<CameraFault> fault(Stamp now) const;

 private:
  void learn_pace(Stamp captured);
  [[nodiscard]] Duration silence_to_miss() const;

  CameraWatchOptions options_;
  std::optional<Stamp> last_capture_;
  double period_s_ = 0.0;  ///< the shortest time between two captures
  double pace_s_ = 0.0;    ///< the mean time between two that arrive
  std::optional<Stamp> last_arrival_;
  std::optional<std::uint64_t> last_picture_;
  std::optional<CameraFault> fault_;  ///< of the newest frame
};

}  // namespace lodestar
