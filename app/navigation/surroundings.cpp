#include "app/navigation/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <utility>

#include "app/navigation/path_obstacles.hpp"
#include "app/navigation/scanner_stops.hpp"
#include "localization/scan/veil.hpp"
#include "maps/smoothed_ends.hpp"
#include "maps/standing_rays.hpp"

namespace lodestar {
namespace {

/// Below this a robot that is slowed by the field counts as standing.
constexpr double standing_mps = 0.02;
constexpr double standing_radps = 0.02;

void append(const std::vector<FieldPoint>& points, std::vector<FieldPoint>& to) {
  to.insert(to.end(), points.begin(), points.end());
}

bool is_same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && !a.empty() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

/// Faster than a robot that stands.
bool moves(const BodyVelocity& velocity) {
  return std::abs(velocity.forward_mps) >= standing_mps || std::abs(velocity.turn_radps) >= standing_radps;
}

/// Of the robot, with 13 cm for a leg's other side and the noise of the range.
ObstacleMemoryOptions memory_around(const SurroundingsOptions& options) {
  ObstacleMemoryOptions memory = options.memory;
  memory.becomes_leg_from_m = options.shape.outer_radius_m() + options.field.body_margin_m + 0.13;
  return memory;
}

}  // namespace

Surroundings::Surroundings(const SurroundingsOptions& options)
    : options_(options),
      outline_{.shape = options.shape},
      field_(options.shape, options.field),
      track_(options.wheels),
      watch_(options.watch),
      contradiction_(options.contradiction),
      memory_(memory_around(options)),
      lingering_(options.lingering),
      release_(options.release),
      holding_(options.holding) {
  if (!options.depth) return;
  ObstacleMemoryOptions memory = memory_around(options);
  memory.seen_free_within_m = 0.7 * options.depth->mount.range_m;  // beyond, noise lets edges come and go
  above_.emplace(Above{.slab = HeightSlab(options.depth->mount, outline_, options.depth->slab),
                       .memory = ObstacleMemory(memory),
                       .waiting = {},
                       .newest = std::nullopt,
                       .points = {}});
}

void Surroundings::add(std::span<const WheelTravel> travel, std::span<const Scan> scans,
                       std::span<const DepthImage> depths, Stamp now, const MappedPose& mapped) {
  constexpr std::size_t most_waiting = 3;
  for (const WheelTravel& reading : travel) {
    track_.add(reading);
    watch_.add_travel(reading);
  }
  for (const Scan& scan : scans)
    if (!watch_.update(scan, now)) {
      own_parts_.add(scan, options_.mount, outline_);
      waiting_.push_back(scan);
    }
  while (waiting_.size() > most_waiting) waiting_.pop_front();
  while (!waiting_.empty() && take(waiting_.front(), mapped)) waiting_.pop_front();
  if (!above_) return;
  above_->waiting.insert(above_->waiting.end(), depths.begin(), depths.end());
  while (above_->waiting.size() > most_waiting) above_->waiting.pop_front();
  while (!above_->waiting.empty() && take(above_->waiting.front(), mapped)) above_->waiting.pop_front();
}

/// False while the wheel readings of the scan's time are missing.
bool Surroundings::take(const Scan& scan, const MappedPose& mapped) {
  const std::optional<std::vector<Pose2>> odom_from_base = poses_during(scan, track_);
  if (!odom_from_base) return false;
  const DeskewedScan placed =
      without_veils(deskewed(scan, options_.mount, *odom_from_base, outline_, own_parts_));
  memory_.add(placed);
  const std::optional<Pose2> map_from_odom = this->map_from_odom(mapped);
  field_scan_ =
      FieldScan{.newest = placed.newest, .points = presences(placed, memory_, map_from_odom, mapped)};
  lingering_.add(field_scan_->points, placed.newest);
  append(corners_of(placed, map_from_odom, mapped), field_scan_->points);
  scanned_points_ = field_scan_->points.size();
  if (above_) append(above_->points, field_scan_->points);
  if (map_from_odom) hold_against_map(scan, *odom_from_base, *map_from_odom, mapped);
  return true;
}

/// The same of a depth image. One that repeats the last is none: each has noise of its own.
bool Surroundings::take(const DepthImage& image, const MappedPose& mapped) {
  if (above_->newest && image.stamp - *above_->newest < options_.depth->least_period) return true;
  if (is_same(image.depth_mm, above_->last_mm)) return true;
  const std::optional<Pose2> odom_from_base = track_.pose_at(image.stamp);
  if (!odom_from_base) return false;
  const DeskewedScan seen = above_->slab.add(image, *odom_from_base);
  above_->memory.add(seen);
  above_->points = presences(seen, above_->memory, map_from_odom(mapped), mapped);
  above_->newest = image.stamp;
  above_->last_mm = image.depth_mm;
  if (!field_scan_) return true;
  field_scan_->points.resize(scanned_points_);
  append(above_->points, field_scan_->points);
  return true;
}

std::vector<const ObstacleMemory*> Surroundings::memories() const {
  std::vector<const ObstacleMemory*> memories{&memory_};
  if (above_) memories.push_back(&above_->memory);
  return memories;
}

std::optional<Pose2> Surroundings::map_from_odom(const MappedPose& mapped) const {
  if (!mapped.estimate) return std::nullopt;
  const std::optional<Pose2> odom_from_base = track_.pose_at(mapped.estimate->stamp);
  if (!odom_from_base) return std::nullopt;
  return mapped.estimate->map_from_base * inverse(*odom_from_base);
}

void Surroundings::hold_against_map(const Scan& scan, std::span<const Pose2> odom_from_base,
                                    const Pose2& map_from_odom, const MappedPose& mapped) {
  std::vector<Pose2> map_from_scanner;
  map_from_scanner.reserve(odom_from_base.size());
  for (const Pose2& pose : odom_from_base)
    map_from_scanner.push_back(map_from_odom * pose * options_.mount.base_from_scanner);
  watch_.add_trusted(scan, map_from_scanner, mapped.map);
  const Eigen::Matrix3d& covariance = mapped.estimate->covariance;
  contradiction_.update(scan, map_from_scanner, mapped.map.map(),
                        {.position_m = larger_sigma(covariance.topLeftCorner<2, 2>()),
                         .heading_rad = std::sqrt(std::max(covariance(2, 2), 0.0))});
}

/// When the ray was measured, and deeper than the noise of the range: it touches the robot, or lies over the
/// scanner, wherever that is mounted.
bool Surroundings::is_within_robot(const Ray& ray) const {
  if (range_m(ray) > 2.0 * options_.shape.outer_radius_m()) return false;
  const std::optional<Pose2> odom_from_base = track_.pose_at(ray.stamp);
  return odom_from_base &&
         options_.shape.distance_m(inverse(*odom_from_base) * ray.end_m) < -outline_.margin_m;
}

std::vector<FieldPoint> Surroundings::presences(const DeskewedScan& scan, const ObstacleMemory& memory,
                                                const std::optional<Pose2>& map_from_odom,
                                                const MappedPose& mapped) const {
  std::vector<FieldPoint> points;
  std::optional<MapExplanation> explanation;
  if (map_from_odom) explanation.emplace(mapped.map, mapped.estimate->covariance);
  const std::vector<bool> stands = rays_at_what_stands(scan, memory);
  const auto presence_of = [&](std::size_t i) {
    const Ray& ray = scan.rays[i];
    if (is_within_robot(ray)) return Presence::person;  // nothing can stand there
    if (explanation && explanation->explains(*map_from_odom * ray.end_m, range_m(ray)))
      return Presence::mapped;
    if (!stands[i]) return Presence::person;
    if (memory.may_go(ray.end_m)) return Presence::waiting;
    return memory.has_legs(ray.end_m) ? Presence::legs : Presence::standing;
  };
  const std::vector<Vec2> smoothed_m = smoothed_ends_m(scan);
  for (std::size_t i = 0; i < scan.rays.size(); ++i) {
    const Ray& ray = scan.rays[i];
    if (!ends_at_something(ray)) continue;
    const Presence presence = presence_of(i);  // what does not move is passed closely
    points.push_back({ray.stamp, is_still(presence) ? smoothed_m[i] : ray.end_m, presence});
  }
  return points;
}

std::vector<FieldPoint> Surroundings::corners_of(const DeskewedScan& scan,
                                                 const std::optional<Pose2>& map_from_odom,
                                                 const MappedPose& mapped) const {
  const OccupancyMap& map = mapped.map.map();
  const auto can_stand = [&](const Vec2& point_in_odom) {
    if (!map_from_odom) return true;
    const Cell cell = map.cell_at(*map_from_odom * point_in_odom);
    return map.contains(cell) && is_drivable(map.at(cell));
  };
  return hidden_corners(scan, options_.corners, can_stand);
}

std::optional<StopReason> Surroundings::reason_to_stop(Stamp now) const {
  if (const std::optional<ScannerFault> fault = watch_.fault(now)) return stop_for(*fault);
  if (above_ && (!above_->newest || now - *above_->newest > options_.depth->max_silence))
    return StopReason::depth_silent;
  if (contradiction_.alarm()) return StopReason::map_contradicted;
  return std::nullopt;
}

Surroundings::Allowed Surroundings::allowed(Stamp now, const std::optional<BodyVelocity>& measured,
                                            const BodyVelocity& wanted) {
  const std::optional<Pose2> odom_from_base = track_.pose_at(now);
  const FieldLimit limit =
      odom_from_base
          ? field_.limit(field_scan_, now, *odom_from_base, measured.value_or(track_.velocity()), wanted)
          : FieldLimit{.share = 0.0, .reason = FieldReason::no_scan, .nearest = std::nullopt};
  const double outline_mps = release_.released_mps(now, allowed_mps(limit, wanted, field_.shape()));
  Allowed allowed{slowed_to(outline_mps, wanted, field_.shape()), std::nullopt, std::nullopt};
  hold(now, odom_from_base, limit, allowed.velocity);
  if (!limit.reason || limit.share >= 1.0) return allowed;
  allowed.slowed_by = stop_for(*limit.reason);
  // A robot that is held wants little: it begins anew in each step.
  if (asks_for_motion(wanted) && !moves(allowed.velocity)) allowed.reason = allowed.slowed_by;
  return allowed;
}

void Surroundings::hold(Stamp now, const std::optional<Pose2>& odom_from_base, const FieldLimit& limit,
                        const BodyVelocity& allowed) {
  if (!odom_from_base) return;
  holding_.stand_at(*odom_from_base);
  if (!limit.nearest || moves(allowed)) return;
  const Vec2 hit_in_odom = *odom_from_base * limit.nearest->point_in_base;
  if (is_still(limit.nearest->presence)) holding_.add({.position_m = hit_in_odom, .may_go = false}, now);
  if (limit.nearest->presence == Presence::waiting)
    holding_.add({.position_m = hit_in_odom, .may_go = true}, now);
}

std::optional<SeenSurroundings> Surroundings::seen(Stamp now, const MappedPose& mapped) const {
  const std::optional<Pose2> odom_from_base = track_.pose_at(now);
  if (!field_scan_ || !odom_from_base) return std::nullopt;
  SeenSurroundings seen{.stamp = field_scan_->newest,
                        .points = {},
                        .base_from_odom = inverse(*odom_from_base),
                        .cell_m = options_.memory.cell_m,
                        .cells = {}};
  if (now - seen.stamp <= options_.field.max_scan_age) {
    for (const FieldPoint& point : field_scan_->points)
      seen.points.push_back({seen.base_from_odom * point.point_in_odom, point.presence});
  }
  const std::optional<Pose2> map_from_odom = this->map_from_odom(mapped);
  std::optional<MapExplanation> explanation;
  if (map_from_odom) explanation.emplace(mapped.map, mapped.estimate->covariance);
  for (const ObstacleMemory* memory : memories()) {
    for (const Vec2& center_in_odom : memory->occupied_m(now)) {
      const double range_m = (center_in_odom - odom_from_base->position_m).norm();
      if (explanation && explanation->explains(*map_from_odom * center_in_odom, range_m)) continue;
      seen.cells.push_back({center_in_odom, memory->stands_at(center_in_odom, now)});
    }
  }
  return seen;
}

UnmappedObstacles Surroundings::unmapped(Stamp now, const MappedPose& mapped,
                                         std::span<const Goal> goals) const {
  return {.roomy_m = unmapped_m(now, mapped, goals, options_.roomy),
          .tight_m = unmapped_m(now, mapped, goals, options_.tight),
          .bare_m = unmapped_m(now, mapped, goals, RoomAround{})};
}

std::vector<Vec2> Surroundings::unmapped_m(Stamp now, const MappedPose& mapped, std::span<const Goal> goals,
                                           const RoomAround& room) const {
  const std::optional<Pose2> map_from_odom = this->map_from_odom(mapped);
  if (!map_from_odom) return {};
  const MapExplanation explanation(mapped.map, mapped.estimate->covariance);
  PathObstacles obstacles(explanation, *map_from_odom,
                          {.robot_m = mapped.estimate->map_from_base.position_m,
                           .goals = goals,
                           .room_m = options_.shape.outer_radius_m() + options_.begins_beside_m});
  for (const ObstacleMemory* memory : memories()) {
    for (const Vec2& thing_m : memory->standing_m(now)) obstacles.add(thing_m, room.things_m);
    for (const Vec2& someone_m : memory->standing_people_m(now)) obstacles.add(someone_m, room.legs_m);
    for (const Vec2& post_m : memory->standing_posts_m(now)) obstacles.add(post_m, room.posts_m);
  }
  const auto before_goals_m = [&](const Vec2& hit_m, double radius_m) {
    return std::min(radius_m, obstacles.room_before_goals_m(hit_m));
  };
  if (room.lingering_m > 0.0)
    for (const Vec2& hit_m : lingering_.hits_m(now))
      obstacles.add(hit_m, std::min(before_goals_m(hit_m, room.lingering_m),
                                    obstacles.room_before_robot_m(hit_m) - options_.leaves_m));
  for (const HoldingPoint& point : holding_.points(now))
    obstacles.add_also_if_mapped(point.position_m,
                                 point.may_go ? before_goals_m(point.position_m, room.waiting_m) : 0.0);
  return obstacles.points_m();
}

std::optional<UnmappedObstacles> Surroundings::obstacles_in_the_way(Stamp now, const MappedPose& mapped,
                                                                    const Path& path,
                                                                    std::span<const Goal> goals) {
  if (path.waypoints_m.empty() || (last_detour_ && now - *last_detour_ < options_.between_detours))
    return std::nullopt;
  if (!field_scan_ || looked_at_ == field_scan_->newest) return std::nullopt;
  looked_at_ = field_scan_->newest;
  const Vec2& robot_m = path.waypoints_m.front();
  const double within_m = options_.shape.outer_radius_m() + options_.least_margin_m;
  const auto blocks = [&](const Vec2& point_m) {
    const double from_path_m = distance_to_path_m(path, point_m);
    return from_path_m < within_m && from_path_m < (robot_m - point_m).norm();
  };
  const auto is_blocked_with = [&](const RoomAround& room) {
    return std::ranges::any_of(unmapped_m(now, mapped, goals, room), blocks);
  };
  if (!is_blocked_with(options_.roomy)) return std::nullopt;
  last_detour_ = now;
  UnmappedObstacles obstacles = unmapped(now, mapped, goals);
  obstacles.path_is_passable = !is_blocked_with(options_.passable);
  return obstacles;
}

}  // namespace lodestar
