#include "localization/pose_filter.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

constexpr Eigen::Index left_scale = 3;
constexpr Eigen::Index right_scale = 4;

/// A short way on an arc of constant curvature: forward along the mean direction, then the whole turn.
struct Arc {
  double length_m = 0.0;
  double turn_rad = 0.0;
};

Arc arc_of(double left_m, double right_m, double track_width_m) {
  return {0.5 * (left_m + right_m), (right_m - left_m) / track_width_m};
}

Pose2 along(const Pose2& from, const Arc& arc) {
  const double half = 0.5 * arc.turn_rad;
  const double chord = std::abs(half) < 1e-6 ? arc.length_m : arc.length_m * std::sin(half) / half;
  const double direction = from.yaw_rad + half;
  return {from.position_m + chord * Vec2(std::cos(direction), std::sin(direction)),
          wrap_angle(from.yaw_rad + arc.turn_rad)};
}

/// Derivative of the pose after an arc by the two wheels' ways; the chord stands for the arc.
Eigen::Matrix<double, 3, 2> pose_by_wheels(double yaw_rad, const Arc& arc, double track_width_m) {
  const double direction = yaw_rad + 0.5 * arc.turn_rad;
  const Vec2 ahead(std::cos(direction), std::sin(direction));
  const Vec2 aside(-ahead.y(), ahead.x());
  const Vec2 by_turn = 0.5 * arc.length_m * aside / track_width_m;
  Eigen::Matrix<double, 3, 2> jacobian;
  jacobian.col(0) << 0.5 * ahead - by_turn, -1.0 / track_width_m;
  jacobian.col(1) << 0.5 * ahead + by_turn, 1.0 / track_width_m;
  return jacobian;
}

WheelTravel interpolated(const WheelTravel& before, const WheelTravel& after, Stamp stamp) {
  const double share = seconds(stamp - before.stamp) / seconds(after.stamp - before.stamp);
  return {stamp, std::lerp(before.left_m, after.left_m, share),
          std::lerp(before.right_m, after.right_m, share)};
}

Vec3 difference(const Pose2& a, const Pose2& b) {
  return {a.position_m.x() - b.position_m.x(), a.position_m.y() - b.position_m.y(),
          wrap_angle(a.yaw_rad - b.yaw_rad)};
}

double squared_mahalanobis(const Vec3& error, const Eigen::Matrix3d& covariance) {
  return error.dot(covariance.ldlt().solve(error));
}

}  // namespace

PoseFilter::PoseFilter(const PoseFilterOptions& options) : options_(options) {}

void PoseFilter::add_travel(const WheelTravel& travel) {
  if (beliefs_.empty()) {
    beliefs_.push_back({.travel = travel, .odometry = {}});
    return;
  }
  if (travel.stamp <= beliefs_.back().travel.stamp) return;
  beliefs_.push_back(moved(beliefs_.back(), travel));
  forget_the_old();
}

PoseFilter::Belief PoseFilter::moved(const Belief& from, const WheelTravel& travel) const {
  const Vec2 rolled(travel.left_m - from.travel.left_m, travel.right_m - from.travel.right_m);
  const Vec2 scaled = rolled.cwiseProduct(from.mean.tail<2>());
  const Arc arc = arc_of(scaled[0], scaled[1], options_.track_width_m);
  const Pose2 pose = along({from.mean.head<2>(), from.mean[2]}, arc);

  Belief to = from;
  to.travel = travel;
  to.odometry = along(from.odometry, arc_of(rolled[0], rolled[1], options_.track_width_m));
  to.mean.head<3>() << pose.position_m, pose.yaw_rad;

  const Eigen::Matrix<double, 3, 2> by_wheels = pose_by_wheels(from.mean[2], arc, options_.track_width_m);
  StateCovariance transition = StateCovariance::Identity();
  transition(0, 2) = -(pose.position_m.y() - from.mean.y());
  transition(1, 2) = pose.position_m.x() - from.mean.x();
  transition.topRightCorner<3, 2>() = by_wheels * rolled.asDiagonal();
  const Vec2 way = rolled.cwiseAbs();
  const double noise = options_.wheel_noise_m_per_sqrt_m * options_.wheel_noise_m_per_sqrt_m;
  const double drift = options_.wheel_scale_drift_per_sqrt_m * options_.wheel_scale_drift_per_sqrt_m;
  to.covariance = transition * from.covariance * transition.transpose();
  to.covariance.topLeftCorner<3, 3>() += by_wheels * (noise * way).asDiagonal() * by_wheels.transpose();
  to.covariance.diagonal().tail<2>() += drift * way;
  return to;
}

FixOutcome PoseFilter::add_fix(const PlanarFix& fix) {
  const std::optional<std::size_t> index = insert_belief_at(fix.stamp);
  if (!index) return FixOutcome::refused_late;
  const Candidate candidate{fix, beliefs_[*index].odometry};
  if (!last_fix_) {
    if (!confirmed(candidate, options_.fixes_to_start)) return FixOutcome::collecting;
    restart_at(*index, fix);
    return FixOutcome::started;
  }

  Belief& belief = beliefs_[*index];
  const Eigen::Matrix3d covariance = widened(fix.covariance);
  const Vec3 innovation = difference(fix.map_from_base, {belief.mean.head<2>(), belief.mean[2]});
  const Eigen::Matrix3d innovation_covariance = belief.covariance.topLeftCorner<3, 3>() + covariance;
  if (squared_mahalanobis(innovation, innovation_covariance) > options_.gate_chi2) {
    if (!confirmed(candidate, options_.fixes_to_relocate)) return FixOutcome::refused_gate;
    restart_at(*index, fix);
    return FixOutcome::relocated;
  }
  candidates_.clear();
  correct(belief, fix, covariance);
  replay_after(*index);
  last_fix_ = std::max(*last_fix_, fix.stamp);
  return FixOutcome::accepted;
}

/// The index of a belief at this very time, made by going part of the way between two wheel readings, or
/// beyond the newest at the same pace. Nothing when the time is out of reach.
std::optional<std::size_t> PoseFilter::insert_belief_at(Stamp stamp) {
  if (beliefs_.size() < 2 || stamp < beliefs_.front().travel.stamp ||
      stamp > beliefs_.back().travel.stamp + options_.max_ahead) {
    return std::nullopt;
  }
  const auto after =
      std::ranges::lower_bound(beliefs_, stamp, {}, [](const Belief& b) { return b.travel.stamp; });
  if (after != beliefs_.end() && after->travel.stamp == stamp)
    return static_cast<std::size_t>(after - beliefs_.begin());
  const auto next = after == beliefs_.end() ? std::prev(after) : after;
  const auto before = std::prev(next);
  const WheelTravel travel = interpolated(before->travel, next->travel, stamp);
  const Belief belief = moved(after == beliefs_.end() ? *next : *before, travel);
  const auto inserted =
      beliefs_.insert(after, belief);  // which moves begin(), so not in one expression with it
  return static_cast<std::size_t>(inserted - beliefs_.begin());
}

/// Joseph's form, which keeps the covariance symmetric and positive.
void PoseFilter::correct(Belief& belief, const PlanarFix& fix, const Eigen::Matrix3d& fix_covariance) const {
  using Observation = Eigen::Matrix<double, 3, 5>;
  const Observation observe = Observation::Identity();
  const Vec3 innovation = difference(fix.map_from_base, {belief.mean.head<2>(), belief.mean[2]});
  const Eigen::Matrix3d innovation_covariance = belief.covariance.topLeftCorner<3, 3>() + fix_covariance;
  const Eigen::Matrix<double, 5, 3> gain =
      innovation_covariance.ldlt().solve(belief.covariance.topRows<3>()).transpose();
  const StateCovariance keep = StateCovariance::Identity() - gain * observe;
  belief.mean += gain * innovation;
  belief.mean[2] = wrap_angle(belief.mean[2]);
  belief.covariance = keep * belief.covariance * keep.transpose() + gain * fix_covariance * gain.transpose();
}

/// Believes a fix alone. The wheels' scales, once learned, outlive the robot's being carried elsewhere.
void PoseFilter::restart_at(std::size_t index, const PlanarFix& fix) {
  Belief& belief = beliefs_[index];
  if (!last_fix_) {
    belief.mean[left_scale] = belief.mean[right_scale] = 1.0;
    belief.covariance.setZero();
    belief.covariance.diagonal().tail<2>().setConstant(options_.initial_wheel_scale_sigma *
                                                       options_.initial_wheel_scale_sigma);
  }
  belief.mean.head<3>() << fix.map_from_base.position_m, fix.map_from_base.yaw_rad;
  belief.covariance.topRows<3>().setZero();
  belief.covariance.leftCols<3>().setZero();
  belief.covariance.topLeftCorner<3, 3>() = widened(fix.covariance);
  candidates_.clear();
  last_fix_ = fix.stamp;
  replay_after(index);
}

void PoseFilter::replay_after(std::size_t index) {
  for (std::size_t i = index + 1; i < beliefs_.size(); ++i)
    beliefs_[i] = moved(beliefs_[i - 1], beliefs_[i].travel);
}

void PoseFilter::forget_the_old() {
  const Stamp oldest = beliefs_.back().travel.stamp - options_.history;
  while (beliefs_.size() > 2 && beliefs_[1].travel.stamp <= oldest) beliefs_.pop_front();
}

Eigen::Matrix3d PoseFilter::widened(const Eigen::Matrix3d& fix_covariance) const {
  const double position = options_.fix_sigma_floor_m * options_.fix_sigma_floor_m;
  const double heading = options_.fix_sigma_floor_rad * options_.fix_sigma_floor_rad;
  Eigen::Matrix3d covariance = 0.5 * (fix_covariance + fix_covariance.transpose());
  covariance.diagonal() += Vec3(position, position, heading);
  return covariance;
}

/// Does the way that the wheels report lead from the earlier fix to the later one?
bool PoseFilter::agree(const Candidate& earlier, const Candidate& later) const {
  const Pose2 way = inverse(earlier.odometry) * later.odometry;
  const Vec3 error = difference(later.fix.map_from_base, earlier.fix.map_from_base * way);
  const double way_m = way.position_m.norm() + std::abs(way.yaw_rad) * options_.track_width_m;
  const double slip_m = options_.initial_wheel_scale_sigma * way_m;
  const double slip_rad = slip_m / options_.track_width_m;
  Eigen::Matrix3d covariance = widened(earlier.fix.covariance) + widened(later.fix.covariance);
  covariance.diagonal() += Vec3(slip_m * slip_m, slip_m * slip_m, slip_rad * slip_rad);
  return squared_mahalanobis(error, covariance) <= options_.gate_chi2;
}

/// Is this the last of so many consecutive fixes that agree among themselves? One that does not agree begins
/// anew.
bool PoseFilter::confirmed(const Candidate& candidate, int fixes_needed) {
  if (!candidates_.empty() && !agree(candidates_.back(), candidate)) candidates_.clear();
  candidates_.push_back(candidate);
  return static_cast<int>(candidates_.size()) >= fixes_needed;
}

std::optional<PoseEstimate> PoseFilter::estimate() const {
  if (!last_fix_) return std::nullopt;
  const Belief& newest = beliefs_.back();
  return PoseEstimate{.stamp = newest.travel.stamp,
                      .map_from_base = {newest.mean.head<2>(), newest.mean[2]},
                      .covariance = newest.covariance.topLeftCorner<3, 3>(),
                      .last_fix = *last_fix_};
}

Vec2 PoseFilter::wheel_scales() const {
  return last_fix_ ? Vec2(beliefs_.back().mean.tail<2>()) : Vec2::Ones();
}

}  // namespace lodestar
