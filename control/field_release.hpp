#pragma once

#include <deque>
#include <limits>

#include "control/protective_field.hpp"
#include "maps/motion.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

struct FieldReleaseOptions {
  Duration free_for = std::chrono::milliseconds(300);  ///< three scans at 10 Hz
  double rise_mps2 = 0.5;                              ///< the comfortable acceleration (robot.yaml)
  double unlimited_mps = 2.0;  ///< a limit that has risen so far is none; more than the robot can do
};

/// A limit on the outline's speed that falls at once, but rises only to what the field has allowed for a
/// while, and no faster than is comfortable: a field that comes and goes with each scan does not make the
/// robot twitch.
class FieldRelease {
 public:
  static constexpr double none_mps = std::numeric_limits<double>::infinity();

  explicit FieldRelease(const FieldReleaseOptions& options = {}) : options_(options) {}

  /// With what the field allows now (allowed_mps below); once a control step.
  [[nodiscard]] double released_mps(Stamp now, double allowed_mps);

 private:
  struct Allowed {
    Stamp stamp;
    double mps = 0.0;
  };

  FieldReleaseOptions options_;
  std::deque<Allowed> recent_;  ///< rising: the first is the least of the last while
  double released_mps_ = none_mps;
  Stamp last_;
};

/// What the field allows of the wanted velocity, as a speed of the outline; none_mps where it does not limit.
double allowed_mps(const FieldLimit& limit, const BodyVelocity& wanted, const RobotShape& shape);

/// The velocity, slowed so that no point of the outline is faster; the curve's radius is kept.
BodyVelocity slowed_to(double outline_mps, const BodyVelocity& wanted, const RobotShape& shape);

}  // namespace lodestar
