#pragma once

#include <deque>
#include <optional>
#include <string>

#include "maps/motion.hpp"

namespace lodestar {

struct RestOptions {
  // The base's own measurement, where it is quiet. Half of what an AgileX base resolves at its slowest.
  double still_mps = 0.003;
  double still_radps = 0.01;
  /// The estimate's motion over the window, for a base whose measured speed is noisy at rest. Chosen by hand:
  /// a fifth of what the slowest motors move in that time (2 cm/s), and several sigmas of a fix.
  Duration window = std::chrono::milliseconds(400);
  double moved_m = 0.002;
  double turned_rad = 0.004;
};

/// Is the robot at rest? When the base measures no speed, or when the estimate has not moved over a window:
/// the speed that some bases measure is noisy at rest. A value type.
class RestDetector {
 public:
  explicit RestDetector(const RestOptions& options = {}) : options_(options) {}

  /// Call at every step. Stamps ascend.
  void add(Stamp now, const std::optional<BodyVelocity>& measured,
           const std::optional<PoseEstimate>& estimate);

  [[nodiscard]] bool at_rest() const { return is_measured_quiet_ || is_estimate_still(); }

  /// What speaks against rest, for the operator: "the base measures 5 mm/s and 0.3 deg/s".
  [[nodiscard]] std::string why_not() const;

 private:
  struct Place {
    Stamp stamp;
    Pose2 map_from_base;
  };

  [[nodiscard]] bool is_estimate_still() const;

  RestOptions options_;
  std::optional<BodyVelocity> measured_;
  bool is_measured_quiet_ = false;
  std::deque<Place> places_;  ///< by ascending stamp; the first is not younger than the window
};

}  // namespace lodestar
