#include "localization/filter/pose_filter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lodestar {
namespace {

// Chosen by hand; the campaigns of docs/safety.md were driven with them.
constexpr int fixes_to_start = 2;  // consecutive consistent fixes for a start
// Consecutive refused fixes that agree with each other and relocate the estimate.
constexpr int fixes_to_relocate = 5;
/// Below this distance, a relocation needs fixes of two markers or more: a displaced marker contradicts the
/// estimate steadily too.
constexpr double relocation_by_one_marker_m = 0.7;
/// After this many consecutive refused visual-odometry increments, either it or wheel odometry is wrong until
/// a fix agrees.
constexpr int motions_refused_to_doubt = 2;
/// Random error of a wheel that may slip: half a metre later it has led the robot aside by 9 cm.
constexpr double slipping_noise_m_per_sqrt_m = 0.1;
/// Fixes that are ahead of the newest wheel reading by more are refused.
constexpr Duration most_ahead = std::chrono::milliseconds(100);

WheelTravel interpolated(const WheelTravel& before, const WheelTravel& after, Stamp stamp) {
  const double share = seconds(stamp - before.stamp) / seconds(after.stamp - before.stamp);
  return {stamp, std::lerp(before.left_m, after.left_m, share),
          std::lerp(before.right_m, after.right_m, share)};
}

}  // namespace

void PoseFilter::add_travel(const WheelTravel& reading) {
  if (!readings_.empty() && reading.stamp <= readings_.back().stamp) return;
  const WheelTravel travel = zero_velocity_.settled(reading);
  readings_.push_back(travel);
  jitter_.add(reading.stamp);
  options_.reading_jitter_s = jitter_.sigma_s();
  while (readings_.size() > 2 && readings_[1].stamp <= travel.stamp - belief_history) readings_.pop_front();
  if (believed_) believed_->add_travel(travel, options_);
  if (rival_) rival_->history.add_travel(travel, options_);
}

FixOutcome PoseFilter::add_fix(const PlanarFix& fix) {
  const std::optional<PlacedFix> at = placed(fix);
  if (!at || (believed_ && at->travel.stamp < believed_->oldest())) return FixOutcome::refused_late;
  learn_registry(*at);
  if (believed_ && believed_->add_fix(at->fix, at->travel, options_)) {
    rival_.reset();
    last_fix_ = std::max(last_fix_, fix.stamp);
    last_agreed_ = std::max(last_agreed_, fix.stamp);
    end_doubt();
    return FixOutcome::accepted;
  }

  // A fix that the estimate contradicts may be an outlier, or the truth after the robot has been carried
  // away. Only several such fixes that agree with each other, given odometry, decide.
  add_to_rival(*at);
  const bool relocating = believed_.has_value();
  if (!rival_prevails()) return relocating ? FixOutcome::refused_gate : FixOutcome::collecting;
  begin_with(std::move(*rival_), fix.stamp);
  return relocating ? FixOutcome::relocated : FixOutcome::started;
}

/// By the first fix that uses a marker, whether the gate refuses it or not.
void PoseFilter::learn_registry(const PlacedFix& placed) {
  bool is_first = false;
  for (const PlanarByOffset& by_offset : placed.fix.by_offsets)
    is_first = markers_met_.insert(by_offset.id).second || is_first;
  if (!is_first || !believed_ || doubt_) return;
  RegistryVariance::LogDensities log_densities{};
  for (std::size_t i = 0; i < log_densities.size(); ++i) {
    PoseFilterOptions options = options_;
    options.registry_variance = RegistryVariance::candidates.at(i);
    const std::optional<Belief> expected = believed_->at(placed.travel, options);
    if (!expected) return;
    log_densities[i] = log_density(*expected, placed.fix, options);
  }
  registry_.add(log_densities);
  options_.registry_variance = registry_.likeliest();
}

void PoseFilter::add_to_rival(const PlacedFix& placed) {
  if (rival_ && rival_->history.add_fix(placed.fix, placed.travel, options_)) {
    ++rival_->fixes;
  } else {
    rival_ = rival_from(placed);
  }
  rival_->ids.insert(placed.fix.ids.begin(), placed.fix.ids.end());
}

bool PoseFilter::rival_prevails() const {
  if (!believed_) return rival_->fixes >= fixes_to_start;
  const double apart_m =
      (rival_->history.newest().map_from_base().position_m - believed_->newest().map_from_base().position_m)
          .norm();
  const bool by_one_marker = rival_->ids.size() == 1;
  return rival_->fixes >= fixes_to_relocate && (!by_one_marker || apart_m >= relocation_by_one_marker_m);
}

void PoseFilter::begin_with(Rival rival, Stamp last_fix) {
  believed_ = std::move(rival.history);
  rival_.reset();
  last_fix_ = last_agreed_ = last_fix;
  end_doubt();
}

bool PoseFilter::start_at(const PlanarFix& fix) {
  const std::optional<PlacedFix> at = placed(fix);
  if (!at) return false;
  begin_with(rival_from(*at), fix.stamp);
  return true;
}

std::optional<FixExpectation> PoseFilter::expectation(const PlanarFix& fix) const {
  const std::optional<PlacedFix> at = placed(fix);
  if (!at || !believed_) return std::nullopt;
  const std::optional<Belief> belief = believed_->at(at->travel, options_);
  if (!belief) return std::nullopt;
  const Vec2 moved_m = fix.map_from_base.position_m - at->fix.map_from_base.position_m;
  const double moved_rad = fix.map_from_base.yaw_rad - at->fix.map_from_base.yaw_rad;
  const Pose2 expected = belief->map_from_base();
  const double distance = squared_distance(*belief, at->fix, options_);
  return FixExpectation{{expected.position_m + moved_m, wrap_angle(expected.yaw_rad + moved_rad)},
                        distance,
                        distance <= gate_squared_distance()};
}

std::optional<MotionExpectation> PoseFilter::expected_motion(Stamp stamp) const {
  const std::optional<WheelTravel> travel = travel_at(stamp);
  if (!travel || !believed_) return std::nullopt;
  const std::optional<Belief> belief = believed_->at(*travel, options_);
  if (!belief || !belief->keyframe_stamp) return std::nullopt;
  return MotionExpectation{*belief->keyframe_stamp,
                           inverse(belief->map_from_keyframe()) * belief->map_from_base()};
}

bool PoseFilter::set_keyframe(Stamp stamp, double sway_m) {
  const std::optional<WheelTravel> travel = travel_at(stamp);
  return travel && believed_ && believed_->set_keyframe(*travel, sway_m, options_);
}

bool PoseFilter::add_motion(const VisualOdometryIncrement& motion, bool becomes_keyframe) {
  const std::optional<WheelTravel> travel = travel_at(motion.to);
  if (!travel || !believed_) return false;
  if (!believed_->add_motion(motion, *travel, becomes_keyframe, options_)) {
    doubt_odometry(motion, *travel);
    return false;
  }
  if (!doubt_) {
    motions_refused_ = 0;
    last_agreed_ = std::max(last_agreed_, motion.to);
  }
  return true;
}

void PoseFilter::doubt_odometry(const VisualOdometryIncrement& motion, const WheelTravel& travel) {
  ++motions_refused_;
  if (motions_refused_ < motions_refused_to_doubt) return;
  const std::optional<Belief> expected = believed_->at(travel, options_);
  if (!expected) return;
  if (!doubt_) doubt_ = {.keyframe = motion.from, .since = travel};
  if (doubt_->keyframe != motion.from) return;
  const Pose2 by_wheels = expected->map_from_base();
  const Pose2 by_ceiling = expected->map_from_keyframe() * motion.then_from_now;
  doubt_->apart << by_ceiling.position_m - by_wheels.position_m,
      wrap_angle(by_ceiling.yaw_rad - by_wheels.yaw_rad);
}

/// The ceiling may be right, and wheels that slip go on doing so.
Eigen::Matrix3d PoseFilter::covariance_of_doubt() const {
  if (!doubt_) return Eigen::Matrix3d::Zero();
  const WheelTravel& now = readings_.back();
  const double way_m =
      0.5 * (std::abs(now.left_m - doubt_->since.left_m) + std::abs(now.right_m - doubt_->since.right_m));
  const double wheel = square(slipping_noise_m_per_sqrt_m) * way_m;
  const double heading = 2.0 * wheel / square(options_.track_width_m);
  const double position = 0.5 * wheel + heading * square(way_m) / 3.0;
  return doubt_->apart * doubt_->apart.transpose() +
         Eigen::Matrix3d(Vec3(position, position, heading).asDiagonal());
}

void PoseFilter::end_doubt() {
  motions_refused_ = 0;
  doubt_.reset();
}

/// Interpolates between readings; nothing beyond them and for what is older than the history.
std::optional<WheelTravel> PoseFilter::travel_at(Stamp stamp) const {
  if (readings_.size() < 2 || stamp < readings_.front().stamp || stamp > readings_.back().stamp ||
      stamp < readings_.back().stamp - belief_history) {
    return std::nullopt;
  }
  const auto after = std::ranges::lower_bound(readings_, stamp, {}, &WheelTravel::stamp);
  return after->stamp == stamp ? *after : interpolated(*std::prev(after), *after, stamp);
}

/// Nothing for a fix beyond the wheels' readings.
std::optional<PoseFilter::PlacedFix> PoseFilter::placed(const PlanarFix& fix) const {
  if (const std::optional<WheelTravel> travel = travel_at(fix.stamp)) return PlacedFix{fix, *travel};
  const bool is_ahead = readings_.size() >= 2 && fix.stamp > readings_.back().stamp &&
                        fix.stamp <= readings_.back().stamp + most_ahead;
  return is_ahead ? std::optional(at_newest_reading(fix)) : std::nullopt;
}

/// Moves a fix that is ahead of the newest wheel reading back to it, at the wheels' last speed. Half of the
/// distance thus extrapolated counts as uncertainty.
PoseFilter::PlacedFix PoseFilter::at_newest_reading(const PlanarFix& fix) const {
  const WheelTravel& newest = readings_.back();
  const WheelTravel ahead = interpolated(readings_[readings_.size() - 2], newest, fix.stamp);
  const double left_m = ahead.left_m - newest.left_m;
  const double right_m = ahead.right_m - newest.right_m;
  const double uncertainty_m = 0.5 * std::max(std::abs(left_m), std::abs(right_m));
  const double uncertainty_rad = 2.0 * uncertainty_m / options_.track_width_m;
  const Pose2 newest_from_ahead = rolled({}, left_m, right_m, options_.track_width_m);

  PlacedFix placed{fix, newest};
  placed.fix.map_from_base = fix.map_from_base * inverse(newest_from_ahead);
  placed.fix.covariance.diagonal() +=
      Vec3(uncertainty_m * uncertainty_m, uncertainty_m * uncertainty_m, uncertainty_rad * uncertainty_rad);
  return placed;
}

/// Learned scales stay valid when the robot has been carried elsewhere.
PoseFilter::Rival PoseFilter::rival_from(const PlacedFix& placed) const {
  Rival rival{BeliefHistory(belief_from(placed.fix, placed.travel, scales(), options_))};
  for (const WheelTravel& reading : readings_)
    if (reading.stamp > placed.travel.stamp) rival.history.add_travel(reading, options_);
  return rival;
}

std::optional<PoseEstimate> PoseFilter::estimate() const {
  if (!believed_) return std::nullopt;
  const Belief& newest = believed_->newest();
  return PoseEstimate{.stamp = newest.travel.stamp,
                      .map_from_base = newest.map_from_base(),
                      .covariance = pose_covariance(newest, options_) + covariance_of_doubt(),
                      .last_fix = last_fix_,
                      .last_agreed = last_agreed_};
}

std::optional<PoseEstimate> PoseFilter::estimate_at(Stamp stamp) const {
  // A robot at the map's origin at that time.
  const std::optional<PlacedFix> origin = placed({.stamp = stamp});
  if (!origin || !believed_) return std::nullopt;
  const std::optional<Belief> belief = believed_->at(origin->travel, options_);
  if (!belief) return std::nullopt;
  return PoseEstimate{
      .stamp = stamp,
      .map_from_base = belief->map_from_base() * inverse(origin->fix.map_from_base),
      .covariance = pose_covariance(*belief, options_) + origin->fix.covariance + covariance_of_doubt(),
      .last_fix = last_fix_,
      .last_agreed = last_agreed_};
}

WheelScales PoseFilter::scales() const {
  return believed_ ? believed_->newest().scales() : initial_scales(options_);
}

}  // namespace lodestar
