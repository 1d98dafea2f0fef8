#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <vector>

#include "localization/mount.hpp"
#include "maps/motion.hpp"

namespace lodestar {

struct PoseFilterOptions {
  double track_width_m = 0.4;  ///< between the wheels' contact points, as built
  /// Random error of one wheel's travel, per square root of metre rolled.
  double wheel_noise_m_per_sqrt_m = 0.003;
  double initial_wheel_scale_sigma = 0.02;       ///< how unequal the wheels may be before anything is learned
  double wheel_scale_drift_per_sqrt_m = 0.0003;  ///< how fast their scales may change
  double fix_sigma_floor_m = 0.002;              ///< added to every fix: survey and mount are not perfect
  double fix_sigma_floor_rad = radians(0.1);
  double gate_chi2 = 16.27;   ///< a fix farther away (Mahalanobis, 3 dof, 99.9 %) is refused
  int fixes_to_start = 2;     ///< consecutive consistent fixes that a start takes
  int fixes_to_relocate = 5;  ///< consecutive refused fixes that agree among themselves and move the estimate
  Duration history = std::chrono::seconds(1);  ///< fixes older than this are refused
  Duration max_ahead =
      std::chrono::milliseconds(100);  ///< and those that are newer than the wheel travel by more
};

enum class FixOutcome { accepted, started, collecting, refused_gate, refused_late, relocated };

/// Fuses wheel travel and camera fixes by covariance: an extended Kalman filter over (x, y, yaw, left and
/// right wheel scale). A fix is applied at its capture time and the travel since then is replayed over it. A
/// value type: copying it copies the belief.
class PoseFilter {
 public:
  explicit PoseFilter(const PoseFilterOptions& options = {});

  /// Moves the belief by the wheels' travel since the last call. Stamps ascend.
  void add_travel(const WheelTravel& travel);

  /// Corrects the belief at the fix's capture time.
  FixOutcome add_fix(const PlanarFix& fix);

  /// The belief at the newest wheel travel; nothing before the filter has started.
  [[nodiscard]] std::optional<PoseEstimate> estimate() const;

  /// Learned scales (true travel over reported travel), left and right.
  [[nodiscard]] Vec2 wheel_scales() const;

 private:
  using State = Eigen::Matrix<double, 5, 1>;  ///< x, y, yaw, left wheel scale, right wheel scale
  using StateCovariance = Eigen::Matrix<double, 5, 5>;

  /// What held at the time of one wheel reading or fix.
  struct Belief {
    WheelTravel travel;
    Pose2 odometry;  ///< by the wheels alone, from wherever they were first read
    State mean = State::Zero();
    StateCovariance covariance = StateCovariance::Zero();
  };

  /// A fix not yet believed, and where the wheels thought they were at its time.
  struct Candidate {
    PlanarFix fix;
    Pose2 odometry;
  };

  [[nodiscard]] Belief moved(const Belief& from, const WheelTravel& travel) const;
  [[nodiscard]] std::optional<std::size_t> insert_belief_at(Stamp stamp);
  void correct(Belief& belief, const PlanarFix& fix, const Eigen::Matrix3d& fix_covariance) const;
  void restart_at(std::size_t index, const PlanarFix& fix);
  void replay_after(std::size_t index);
  void forget_the_old();
  [[nodiscard]] Eigen::Matrix3d widened(const Eigen::Matrix3d& fix_covariance) const;
  [[nodiscard]] bool agree(const Candidate& earlier, const Candidate& later) const;
  [[nodiscard]] bool confirmed(const Candidate& candidate, int fixes_needed);

  PoseFilterOptions options_;
  std::deque<Belief> beliefs_;  ///< by ascending stamp, over the history; means are valid once started
  std::vector<Candidate> candidates_;
  std::optional<Stamp> last_fix_;  ///< nothing before the start
};

}  // namespace lodestar
