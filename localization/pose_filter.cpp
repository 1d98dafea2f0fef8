#include "localization/pose_filter.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

WheelTravel interpolated(const WheelTravel& before, const WheelTravel& after, Stamp stamp) {
  const double share = seconds(stamp - before.stamp) / seconds(after.stamp - before.stamp);
  return {stamp, std::lerp(before.left_m, after.left_m, share),
          std::lerp(before.right_m, after.right_m, share)};
}

}  // namespace

void PoseFilter::add_travel(const WheelTravel& travel) {
  if (!readings_.empty() && travel.stamp <= readings_.back().stamp) return;
  readings_.push_back(travel);
  while (readings_.size() > 2 && readings_[1].stamp <= travel.stamp - options_.history) readings_.pop_front();
  if (believed_) believed_->add_travel(travel, options_);
  if (rival_) rival_->history.add_travel(travel, options_);
}

FixOutcome PoseFilter::add_fix(const PlanarFix& fix) {
  const std::optional<PlacedFix> at = placed(fix);
  if (!at || (believed_ && at->travel.stamp < believed_->oldest())) return FixOutcome::refused_late;
  if (believed_ && believed_->add_fix(at->fix, at->travel, options_)) {
    rival_.reset();
    last_fix_ = std::max(last_fix_, fix.stamp);
    return FixOutcome::accepted;
  }

  // What the estimate contradicts may be an outlier, or the truth after the robot has been carried away. Only
  // fixes that agree among themselves, given the wheels' travel between them, can tell.
  if (rival_ && rival_->history.add_fix(at->fix, at->travel, options_)) {
    ++rival_->fixes;
  } else {
    rival_ = rival_from(*at);
  }
  const bool relocating = believed_.has_value();
  if (rival_->fixes < (relocating ? options_.fixes_to_relocate : options_.fixes_to_start))
    return relocating ? FixOutcome::refused_gate : FixOutcome::collecting;
  believed_ = std::move(rival_->history);
  rival_.reset();
  last_fix_ = fix.stamp;
  return relocating ? FixOutcome::relocated : FixOutcome::started;
}

/// Nothing for a fix that is out of the readings' reach.
std::optional<PoseFilter::PlacedFix> PoseFilter::placed(const PlanarFix& fix) const {
  if (readings_.size() < 2) return std::nullopt;
  const Stamp newest = readings_.back().stamp;
  if (fix.stamp < readings_.front().stamp || fix.stamp < newest - options_.history ||
      fix.stamp > newest + options_.max_ahead) {
    return std::nullopt;
  }
  if (fix.stamp > newest) return brought_back(fix);
  const auto after = std::ranges::lower_bound(readings_, fix.stamp, {}, &WheelTravel::stamp);
  if (after->stamp == fix.stamp) return PlacedFix{fix, *after};
  return PlacedFix{fix, interpolated(*std::prev(after), *after, fix.stamp)};
}

/// A fix that is ahead of the wheels' last word, brought back to it at the wheels' last pace. Of the way
/// thus guessed half may be wrong.
PoseFilter::PlacedFix PoseFilter::brought_back(const PlanarFix& fix) const {
  const WheelTravel& newest = readings_.back();
  const WheelTravel ahead = interpolated(readings_[readings_.size() - 2], newest, fix.stamp);
  const double left_m = ahead.left_m - newest.left_m;
  const double right_m = ahead.right_m - newest.right_m;
  const double doubt_m = 0.5 * std::max(std::abs(left_m), std::abs(right_m));
  const double doubt_rad = 2.0 * doubt_m / options_.track_width_m;
  const Pose2 newest_from_ahead = rolled({}, left_m, right_m, options_.track_width_m);

  PlacedFix placed{fix, newest};
  placed.fix.map_from_base = fix.map_from_base * inverse(newest_from_ahead);
  placed.fix.covariance.diagonal() += Vec3(doubt_m * doubt_m, doubt_m * doubt_m, doubt_rad * doubt_rad);
  return placed;
}

/// The scales, once learned, outlive the robot's being carried elsewhere.
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
                      .covariance = pose_covariance(newest, options_),
                      .last_fix = last_fix_};
}

WheelScales PoseFilter::scales() const {
  return believed_ ? believed_->newest().scales() : scales_as_built(options_);
}

}  // namespace lodestar
