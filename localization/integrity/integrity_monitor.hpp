#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "localization/filter/pose_filter.hpp"

namespace lodestar {

struct IntegrityOptions {
  /// A fix farther from the estimate is no error of survey, wheels or floor: thirty times the 10 mm error of
  /// markers taped up by hand, and less than 0.4 m, the smallest displacement of a carried robot in `lodestar
  /// campaign`.
  double gross_m = 0.3;
  double gross_rad = radians(20.0);
  int gross_fixes_to_stop = 2;  ///< in a row
  /// One marker's fixes may change their error of the estimate by this while all of them contradict.
  double steady_m = 0.04;
  double steady_rad = radians(4.0);
  double rolled_m = 0.01;  ///< wheels that rolled less have not moved the robot: it was carried
  Duration calm = std::chrono::seconds(1);  ///< time without a new cause before the robot may drive on
  /// This many odometry failures within `memory` are no accident.
  std::size_t most_wheel_errors = 3;
  Duration memory = std::chrono::seconds(20);
};

/// Why the estimate is not trusted.
enum class IntegrityAlarm {
  contradicted,   ///< fixes place the robot far from the estimate
  moved,          ///< the estimate has just been relocated to the fixes
  wheels_wrong,   ///< odometry contradicts the fixes by a changing error
  carried_away,   ///< the robot was carried elsewhere, or the only marker that it could go by; latched
  wheels_broken,  ///< repeated odometry failures; latched
};

/// A fix, and the filter's decision on it.
struct FixVerdict {
  Stamp stamp;
  std::span<const int> ids;
  Pose2 map_from_base;
  std::optional<Pose2> expected;  ///< the estimate at the fix's time
  FixOutcome outcome = FixOutcome::collecting;
};

/// Watches how fixes contradict the estimate. A displaced marker contradicts steadily: its fixes show the
/// same error of the estimate wherever the robot drives. So does a robot that was carried away, but grossly.
/// Where the error by one marker changes as the robot drives, odometry is wrong. Wheels that slip move the
/// robot no farther than they roll, though: fixes that began to contradict by more are of a marker that was
/// displaced or of a robot that was carried, and no belief starts by them after an odometry failure. A value
/// type.
class IntegrityMonitor {
 public:
  explicit IntegrityMonitor(const IntegrityOptions& options = {}) : options_(options) {}

  void add_travel(const WheelTravel& reading);
  void add_fix(const FixVerdict& fix);

  /// True once per odometry failure: the belief that rests on odometry is void.
  bool take_odometry_failure();

  /// Nothing when the estimate is trusted. Latched alarms last until a new IntegrityMonitor is made.
  [[nodiscard]] std::optional<IntegrityAlarm> alarm(Stamp now) const;

  /// True when fixes have contradicted the estimate and none has agreed since.
  [[nodiscard]] bool is_contradicted() const { return !witnesses_.empty(); }

  /// Distance rolled since a fix agreed with the estimate.
  [[nodiscard]] double rolled_since_agreement_m() const { return rolled_m_ - rolled_at_agreement_m_; }

 private:
  /// Correction of the estimate by the fixes of the same markers, while none agrees.
  struct Witness {
    Pose2 map_from_estimated;
    double rolled_m = 0.0;
    bool is_out_of_reach = false;  ///< farther from the last agreement than the wheels had rolled since
  };

  /// Distance rolled until `stamp`.
  struct Rolled {
    Stamp stamp;
    double distance_m = 0.0;
  };

  /// A place on the way, and the distance rolled until there.
  struct Waypoint {
    Vec2 position_m;
    double rolled_m = 0.0;
  };

  struct OdometryFailure {
    Waypoint estimated;
    std::set<int> ids_out_of_reach;  ///< of the witnesses out of reach
  };

  void agree(const FixVerdict& fix);
  void contradict(const FixVerdict& fix);
  void register_odometry_failure(const FixVerdict& fix);
  [[nodiscard]] double rolled_until_m(Stamp stamp) const;
  [[nodiscard]] bool is_beyond_wheels(const FixVerdict& fix) const;
  [[nodiscard]] bool may_start_by(const FixVerdict& fix) const;
  [[nodiscard]] bool is_gross(const FixVerdict& fix) const;

  IntegrityOptions options_;
  std::optional<WheelTravel> last_travel_;
  std::deque<Rolled> rolled_;  ///< of the last `belief_history`
  double rolled_m_ = 0.0;
  double rolled_at_agreement_m_ = 0.0;
  std::optional<Waypoint> agreed_;  ///< by the last fix that agreed, at its exposure
  int gross_in_a_row_ = 0;
  std::map<std::vector<int>, Witness> witnesses_;
  std::vector<Stamp> wheel_errors_;
  bool failure_is_new_ = false;
  std::optional<OdometryFailure> failure_;
  std::optional<Stamp> moved_at_;
  std::optional<IntegrityAlarm> latched_;
};

}  // namespace lodestar
