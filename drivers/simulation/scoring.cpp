#include "drivers/simulation/scoring.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "drivers/simulation/disc_contact.hpp"

namespace lodestar {
namespace {

/// Below this speed the robot counts as standing or turning on the spot.
constexpr double driving_mps = 0.01;

}  // namespace

Scorer::Scorer(const OccupancyMap& map, double robot_radius_m, std::optional<Footprint> footprint,
               const ContactJudgeOptions& contacts)
    : map_(map),
      robot_radius_m_(robot_radius_m),
      footprint_(std::move(footprint)),
      judge_(map, robot_radius_m, footprint_, contacts) {}

void Scorer::record(const TruePose& truth, bool ran_against_obstacle) {
  const Vec2& position_m = truth.map_from_base.position_m;
  const bool overlaps = footprint_ ? !footprint_->is_clear(map_, truth.map_from_base)
                                   : disc_overlaps_obstacle(map_, position_m, robot_radius_m_);
  const bool touches_map = ran_against_obstacle || overlaps;
  if (touches_map && !touches_map_) {
    ++contacts_;
    greatest_map_contact_mps_ = std::max(greatest_map_contact_mps_, latest_speed_mps_);
  }
  touches_map_ = touches_map;
  if (path_ && has_moved_to(truth)) path_distances_m_.push_back(distance_to_path_m(*path_, position_m));
  latest_speed_mps_ = speed_to_mps(truth);
  track_.push_back(truth);
}

void Scorer::record_discs(const TruePose& truth, std::span<const DiscState> discs) {
  judge_.record(truth.stamp, truth.map_from_base, discs);
}

void Scorer::change_map(const OccupancyMap& map) {
  map_ = map;
  judge_.change_map(map);
}

ContactScore Scorer::contact_score() const {
  ContactScore score = judge_.score();
  score.moving += contacts_;
  score.greatest_contact_mps = std::max(score.greatest_contact_mps, greatest_map_contact_mps_);
  return score;
}

double Scorer::speed_to_mps(const TruePose& truth) const {
  if (track_.empty()) return 0.0;
  const double moved_m = (truth.map_from_base.position_m - track_.back().map_from_base.position_m).norm();
  return moved_m / std::max(seconds(truth.stamp - track_.back().stamp), 1e-9);
}

bool Scorer::has_moved_to(const TruePose& truth) const {
  return !track_.empty() && speed_to_mps(truth) > driving_mps;
}

void Scorer::claim_arrival(const Vec2& goal_m, std::optional<double> heading_rad) {
  path_.reset();
  if (track_.empty()) return;
  const Pose2& truth = track_.back().map_from_base;
  ArrivalScore score{(truth.position_m - goal_m).norm(), std::nullopt};
  if (heading_rad) score.heading_error_rad = std::abs(wrap_angle(truth.yaw_rad - *heading_rad));
  arrivals_.push_back(score);
}

void Scorer::forget() {
  constexpr std::ptrdiff_t newest = 10;
  track_.erase(track_.begin(), track_.end() - std::min(newest, std::ssize(track_)));
  arrivals_.clear();
  path_distances_m_.clear();
  contacts_ = 0;
  judge_.forget();
  greatest_map_contact_mps_ = 0.0;
}

void Scorer::claim_path(const Path& path) {
  path_.reset();
  if (!path.waypoints_m.empty()) path_ = path;
}

}  // namespace lodestar
