#pragma once

#include <array>
#include <optional>

#include "maps/motion.hpp"

namespace lodestar {

/// How far the measured speed may lie outside the band, and for how long.
struct FollowingTolerance {
  double forward_mps = 0.0;
  double turn_radps = 0.0;
  Duration patience{};
  double share = 0.0;  ///< of the command, where that is more
};

struct CommandFollowingOptions {
  std::array<FollowingTolerance, 3> tolerances{{
      {.forward_mps = 0.3, .turn_radps = 0.8, .patience = std::chrono::milliseconds(200)},
      // One stuck wheel of a slow robot deviates by no more than this.
      {.forward_mps = 0.15, .turn_radps = 0.35, .patience = std::chrono::seconds(1)},
      // And one of a robot that creeps at 0.05 m/s: its controller turns against what the stuck wheel reports
      // until the other one stands by the reports, too, at 2 x 0.05 m/s over the track width.
      {.forward_mps = 0.1, .turn_radps = 0.2, .patience = std::chrono::milliseconds(1500), .share = 0.5},
  }};
  double min_acceleration_mps2 = 1.0;  ///< reached by any healthy base, towards the command
  double min_turn_acceleration_radps2 = 3.0;
  Duration max_interval = std::chrono::milliseconds(50);  ///< most that counts of the time between two calls
};

/// Monitors whether the base follows its commands. A reference speed models the slowest healthy base; the
/// measured speed must lie between it and the command, within the tolerances.
///
///     command    ____________________
///               /  measured: fine    .
///     slowest  /________/             .   a runaway base, or one that ignores commands, leaves the band
///
class CommandFollowing {
 public:
  explicit CommandFollowing(const CommandFollowingOptions& options = {}) : options_(options) {}

  /// Restarts from the present measured velocity.
  void restart(Stamp now, const BodyVelocity& measured);

  /// True when the measured velocity has been outside the band for longer than a tolerance allows. To be
  /// called at a steady rate: a pause of the caller, without commands and measurements, counts for at most
  /// `max_interval`.
  [[nodiscard]] bool strays(Stamp now, const BodyVelocity& commanded, const BodyVelocity& measured);

 private:
  CommandFollowingOptions options_;
  Stamp last_;
  std::array<Duration, 3> strayed_{};  ///< by more than each tolerance, without a break
  BodyVelocity slowest_;
};

}  // namespace lodestar
