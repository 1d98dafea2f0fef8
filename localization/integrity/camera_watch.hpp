#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string_view>

#include "maps/frame.hpp"

namespace lodestar {

/// Camera faults.
enum class CameraFault {
  silent,       ///< no frame has come for several periods
  repeats,      ///< the same image again: no two exposures have equal noise
  dark,         ///< the whole image is black
  bright,       ///< the whole image is white
  late,         ///< frames arrive long after their exposure
  other_clock,  ///< stamped in the future, or far in the past
};

// Message for the operator.
std::string_view to_string(CameraFault fault);

struct CameraWatchOptions {
  /// Silence that counts as a fault: at least this and three of the camera's periods. Longer for a camera
  /// that loses frames, so that there is one false alarm in `frames_to_a_false_alarm` frames, up to
  /// `longest_silence`.
  Duration max_silence = std::chrono::milliseconds(150);
  double frames_to_a_false_alarm = 1e5;
  Duration longest_silence = std::chrono::milliseconds(500);
  Duration max_age = std::chrono::milliseconds(250);   ///< of a frame on arrival, since mid-exposure
  Duration max_ahead = std::chrono::milliseconds(20);  ///< of the stamp relative to the arrival
  Duration another_age = std::chrono::seconds(5);      ///< a stamp older than this is from another clock
  int dark_gray = 20;     ///< an image whose brightest sampled pixel is darker is dark
  int bright_gray = 240;  ///< an image whose darkest sampled pixel is brighter is bright
};

/// Decides which frames are usable, and watches for camera faults. A value type.
class CameraWatch {
 public:
  explicit CameraWatch(const CameraWatchOptions& options = {}) : options_(options) {}

  /// Fault of a frame that has just arrived; nothing when it is usable. Dark and bright frames count as
  /// usable, but fault() reports them.
  std::optional<CameraFault> update(const Frame& frame, Stamp now);

  /// Current fault of the camera. Silence is no fault before the first frame.
  [[nodiscard]] std::optional<CameraFault> fault(Stamp now) const;

 private:
  void learn_pace(Stamp captured);
  [[nodiscard]] Duration silence_to_miss() const;

  CameraWatchOptions options_;
  std::optional<Stamp> last_capture_;
  std::deque<double> intervals_s_;  ///< the last ones between two captures
  double period_s_ = 0.0;           ///< the shortest of them but for outliers
  double pace_s_ = 0.0;             ///< mean time between the captures of frames that arrive
  std::optional<Stamp> last_arrival_;
  std::optional<std::uint64_t> last_picture_;
  std::optional<CameraFault> fault_;  ///< of the newest frame
};

}  // namespace lodestar
