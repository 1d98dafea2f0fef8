#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "localization/filter/pose_filter.hpp"

namespace lodestar {

struct IntegrityOptions {
  /// A fix farther from the estimate is no error of survey, wheels or floor: thirty times the 10 mm by which
  /// markers taped up by hand are off, and less than the 0.4 m by which `lodestar campaign` carries robots
  /// off at least.
  double gross_m = 0.3;
  double gross_rad = radians(20.0);
  int gross_fixes_to_stop = 2;  ///< in a row
  /// What one marker says of the estimate's error may change by so much while all of its fixes contradict.
  double steady_m = 0.04;
  double steady_rad = radians(4.0);
  double rolled_m = 0.01;  ///< less than this the wheels have not moved the robot: somebody else has
  Duration calm = std::chrono::seconds(1);  ///< without a new cause, before the robot may go on
  /// So many times that the wheels were wrong, within this time, are no accident.
  std::size_t most_wheel_errors = 3;
  Duration memory = std::chrono::seconds(20);
};

/// Why the estimate is in doubt.
enum class IntegrityAlarm {
  contradicted,   ///< fixes say that the robot is somewhere quite else
  moved,          ///< the estimate has just moved to where fixes say that the robot is
  wheels_wrong,   ///< the wheels say otherwise than what is seen, more and more
  carried_away,   ///< somebody has put the robot elsewhere; for good
  wheels_broken,  ///< the wheels were wrong again and again; for good
};

/// What one fix said, and what came of it.
struct FixVerdict {
  Stamp stamp;
  std::span<const int> ids;
  Pose2 map_from_base;
  std::optional<Pose2> expected;  ///< where the estimate had the robot
  FixOutcome outcome = FixOutcome::collecting;
};

/// Watches how fixes contradict the estimate. A marker that hangs elsewhere contradicts steadily: it always
/// sees the same error of the estimate, wherever the robot drives. So does a robot that was carried away, but
/// grossly. Where the error of one marker changes as the robot drives, it is the wheels that are wrong. A
/// value type.
class IntegrityMonitor {
 public:
  explicit IntegrityMonitor(const IntegrityOptions& options = {}) : options_(options) {}

  void add_travel(const WheelTravel& reading);
  void add_fix(const FixVerdict& fix);

  /// True once for each time that the wheels turned out wrong: what was believed by them is void.
  bool take_odometry_failure();

  /// Nothing when there is no doubt. For good means: until somebody makes a new Doubt.
  [[nodiscard]] std::optional<IntegrityAlarm> alarm(Stamp now) const;

  /// Have fixes contradicted the estimate, and none agreed since?
  [[nodiscard]] bool is_contradicted() const { return !witnesses_.empty(); }

  /// How far the wheels have rolled since a fix agreed with the estimate.
  [[nodiscard]] double rolled_since_agreement_m() const { return rolled_m_ - rolled_at_agreement_m_; }

 private:
  /// What the fixes of one marker say, as long as none agrees: where the estimate must be moved.
  struct Witness {
    Pose2 map_from_estimated;
    double rolled_m = 0.0;
  };

  /// Where the estimate had the robot when its wheels turned out wrong.
  struct OdometryFailure {
    Vec2 position_m;
    double rolled_m = 0.0;
  };

  void agree();
  void contradict(const FixVerdict& fix);
  void register_odometry_failure(const FixVerdict& fix);
  [[nodiscard]] bool is_out_of_reach(const FixVerdict& start) const;
  [[nodiscard]] bool is_gross(const FixVerdict& fix) const;

  IntegrityOptions options_;
  std::optional<WheelTravel> last_travel_;
  double rolled_m_ = 0.0;
  double rolled_at_agreement_m_ = 0.0;
  int gross_in_a_row_ = 0;
  std::map<int, Witness> witnesses_;
  std::vector<Stamp> wheel_errors_;
  bool failure_is_new_ = false;
  std::optional<OdometryFailure> failure_;
  std::optional<Stamp> moved_at_;
  std::optional<IntegrityAlarm> latched_;
};

}  // namespace lodestar
