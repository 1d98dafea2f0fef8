#pragma once

#include <optional>

#include "maps/motion.hpp"

namespace lodestar {

struct CommandFollowingOptions {
  double max_forward_error_mps = 0.3;
  double max_turn_error_radps = 0.8;
  double least_acceleration_mps2 = 1.0;  ///< what any healthy base reaches, towards the command
  double least_turn_acceleration_radps2 = 3.0;
  Duration patience = std::chrono::milliseconds(200);
  Duration longest_look = std::chrono::milliseconds(50);  ///< of the time between two looks, what counts
};

/// Does the base do as it is told? Beside the command runs the speed that the slowest healthy base would
/// have; the measured speed must lie between the two, within the tolerance.
///
///     command    ____________________
///               /  measured: fine    .
///     slowest  /________/             .   a runaway base, or one that ignores commands, leaves the band
///
class CommandFollowing {
 public:
  explicit CommandFollowing(const CommandFollowingOptions& options = {}) : options_(options) {}

  /// Starts anew from what the base does now.
  void restart(Stamp now, const BodyVelocity& measured);

  /// True when the measured velocity has been outside the band for longer than the patience. To be called at
  /// a steady rate: of a pause of the caller's own, in which nobody commanded or looked, little counts.
  [[nodiscard]] bool strays(Stamp now, const BodyVelocity& commanded, const BodyVelocity& measured);

 private:
  CommandFollowingOptions options_;
  Stamp last_;
  Duration strayed_{};
  BodyVelocity slowest_;
};

}  // namespace lodestar
