#pragma once

#include <optional>
#include <span>

#include "maps/motion.hpp"

namespace lodestar {

/// The camera's heading in the map in one frame, by the frame's stamp.
struct HeadingSample {
  Stamp stamp;
  double yaw_rad = 0.0;
};

struct TimeOffsetOptions {
  Duration largest = std::chrono::milliseconds(250);  ///< searched in both directions
  Duration step = std::chrono::milliseconds(5);       ///< of the search
  Duration width = std::chrono::milliseconds(50);     ///< to each side, of the parabola through the minimum
  Duration longest_gap = std::chrono::milliseconds(500);  ///< between two frames that are compared
  std::size_t least_pairs = 40;
  double most_sigma_s = 0.005;  ///< with a larger standard deviation there is no result
};

/// How much later the frames are stamped than they were exposed, on the clock of the wheels.
struct TimeOffset {
  double late_s = 0.0;
  double sigma_s = 0.0;

  [[nodiscard]] bool is_significant() const;
};

/// Compares the turns that the camera saw with those that the wheels rolled: only where the turn rate
/// changes, as at the begin and the end of a turn, does a shift in time make a difference. Nothing when the
/// robot turned too little, or too steadily. Both inputs are in order of time.
std::optional<TimeOffset> estimate_time_offset(std::span<const HeadingSample> frames,
                                               std::span<const WheelTravel> wheels, double track_width_m,
                                               const TimeOffsetOptions& options = {});

}  // namespace lodestar
