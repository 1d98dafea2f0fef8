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

Scorer::Scorer(const OccupancyMap& map, double robot_radius_m, std::optional<Footprint> footprint)
    : map_(map), robot_radius_m_(robot_radius_m), footprint_(std::move(footprint)) {}

void Scorer::record(const TruePose& truth, bool ran_against_obstacle) {
  const Vec2& position_m = truth.map_from_base.position_m;
  const bool overlaps = footprint_ ? !footprint_->is_clear(map_, truth.map_from_base)
                                   : disc_overlaps_obstacle(map_, position_m, robot_radius_m_);
  if (ran_against_obstacle || overlaps) ++contacts_;
  if (path_ && has_moved_to(truth)) path_distances_m_.push_back(distance_to_path_m(*path_, position_m));
  track_.push_back(truth);
}

bool Scorer::has_moved_to(const TruePose& truth) const {
  if (track_.empty()) return false;
  const double moved_m = (truth.map_from_base.position_m - track_.back().map_from_base.position_m).norm();
  return moved_m > driving_mps * seconds(truth.stamp - track_.back().stamp);
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
}

void Scorer::claim_path(const Path& path) {
  path_.reset();
  if (!path.waypoints_m.empty()) path_ = path;
}

}  // namespace lodestar
