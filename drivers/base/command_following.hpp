#pragma once

#include <optional>

#include "maps/motion.hpp"

namespace lodestar {

/// How far the measured speed may lie outside the band, and for how long.
struct FollowingTolerance {
  double forward_mps = 0.0;
  double turn_radps = 0.0;
  Duration patience{};
};

struct CommandFollowingOptions {
  FollowingTolerance gross{.forward_mps = 0.3, .turn_radps = 0.8, .patience = std::chrono::milliseconds(200)};
  /// A wheel that stands while the robot creeps is no more than that.
  FollowingTolerance fine{.forward_mps = 0.15, .turn_radps = 0.35, .patience = std::chrono::seconds(1)};
  double least_acceleration_mps2 = 1.0;  ///< what any healthy base reaches, towards the command
  double least_turn_acceleration_radps2 = 3.0;
  Duration longest_look = std::chrono::milliseconds(50);  ///< of the time between two looks, what counts
};

/// Does the base do as it is told? Beside the command runs the speed that the slowest healthy base would
/// have; the measured speed must lie between the two, within the tolerances.
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

  /// True when the measured velocity has been outside the band for longer than a tolerance allows. To be
  /// called at a steady rate: of a pause of the caller's own, in which nobody commanded or looked, little
  /// counts.
  [[nodiscard]] bool strays(Stamp now, const BodyVelocity& commanded, const BodyVelocity& measured);

 private:
  CommandFollowingOptions options_;
  Stamp last_;
  Duration strayed_grossly_{};
  Duration strayed_{};  ///< by more than the fine tolerance
  BodyVelocity slowest_;
};

}  // namespace lodestar
