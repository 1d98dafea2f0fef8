#include "drivers/simulation/walkers.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "drivers/simulation/disc_contact.hpp"
#include "maps/ray_casting.hpp"

namespace lodestar {
namespace {

// Parameters of Moussaid et al. 2009.
constexpr double social_strength_mps2 = 4.5;
constexpr double weight_of_velocity = 2.0;  // lambda
constexpr double interaction_range = 0.35;  // gamma
constexpr double angular_width = 2.0;       // n
constexpr double braking_width = 3.0;       // n'
constexpr double relaxation_s = 0.54;       // tau

// Walls push as in the same paper, from a person's edge. As in Helbing and Molnar 1995 (10 m/s^2, 0.2 m) they
// push harder than a goal draws, half a metre away: people then wait for minutes before a gap of 0.8 m.
constexpr double wall_strength_mps2 = 3.0;
constexpr double wall_range_m = 0.1;

constexpr double arrived_m = 0.4;
constexpr double from_robot_at_start_m = 2.0;
constexpr Duration longest_way = std::chrono::seconds(15);
/// Who gets no further goes elsewhere: nobody pushes against a robot for long.
constexpr Duration longest_hold_up = std::chrono::seconds(2);
constexpr double walking_mps = 0.05;
/// A threatening person steps out when the robot is so near, to a place so far ahead of it, and stays there.
constexpr double step_out_within_m = 3.5;
constexpr double ahead_of_robot_m = 1.2;
constexpr Duration in_the_way = std::chrono::seconds(4);

Vec2 direction_of(double heading_rad) {
  return {std::cos(heading_rad), std::sin(heading_rad)};
}

/// The part along a wall, and a little off it: who touches two walls at once would stay there for good by
/// rounding. `away` from the wall is of length 1, or zero where there is none.
Vec2 along_wall(const Vec2& away, const Vec2& velocity_mps) {
  constexpr double off_share = 0.1;
  const double speed_mps = velocity_mps.norm();
  const Vec2 along_mps =
      velocity_mps - (std::min(0.0, velocity_mps.dot(away)) - off_share * speed_mps) * away;
  return along_mps.norm() > speed_mps ? Vec2(speed_mps * along_mps.normalized()) : along_mps;
}

/// Of length 1, from the one whose edge is nearest; zero where there is none.
Vec2 away_from_nearest(const DiscState& self, std::span<const DiscState> solids) {
  const auto apart_m = [&](const DiscState& solid) {
    return (self.position_m - solid.position_m).norm() - solid.radius_m;
  };
  const auto nearest = std::ranges::min_element(solids, {}, apart_m);
  if (nearest == solids.end()) return Vec2::Zero();
  return (self.position_m - nearest->position_m).normalized();
}

}  // namespace

Vec2 social_force_mps2(const Vec2& position_m, const Vec2& velocity_mps, const Vec2& other_m,
                       const Vec2& other_velocity_mps) {
  const Vec2 apart_m = other_m - position_m;
  const double distance_m = apart_m.norm();
  if (distance_m < 1e-6) return Vec2::Zero();
  const Vec2 towards = apart_m / distance_m;
  const Vec2 interaction = weight_of_velocity * (velocity_mps - other_velocity_mps) + towards;
  const double strength = interaction.norm();
  if (strength < 1e-6) return Vec2::Zero();
  const Vec2 ahead = interaction / strength;
  const Vec2 left(-ahead.y(), ahead.x());
  const double range_m = interaction_range * strength;
  const double angle_rad = std::atan2(cross(ahead, towards), ahead.dot(towards));
  const double brakes = std::exp(-distance_m / range_m - square(braking_width * range_m * angle_rad));
  const double turns = std::exp(-distance_m / range_m - square(angular_width * range_m * angle_rad));
  // To the right of who is on the left, and straight ahead to the right as well.
  const double side = angle_rad < 0.0 ? 1.0 : -1.0;
  return social_strength_mps2 * (-brakes * ahead + side * turns * left);
}

Vec2 goal_force_mps2(const Walker& walker) {
  const Vec2 way_m = walker.goal_m - walker.disc.position_m;
  const double distance_m = way_m.norm();
  Vec2 wanted_mps = Vec2::Zero();
  if (!walker.waits && distance_m > arrived_m) wanted_mps = walker.wanted_mps / distance_m * way_m;
  return (wanted_mps - walker.disc.velocity_mps) / relaxation_s;
}

Walkers::Walkers(const OccupancyMap& map, const PeopleOptions& options, const Pose2& map_from_base,
                 std::uint64_t seed)
    : map_(map), field_(map), options_(options), random_(seed) {
  for (int i = 0; i < options.count; ++i) {
    Walker walker;
    walker.disc.radius_m = options.radius_m;
    walker.disc.has_legs = options.have_legs;
    const double kind = random_.uniform();
    if (kind < options.threatening_share)
      walker.kind = PersonKind::threatening;
    else if (kind < options.threatening_share + options.oblivious_share)
      walker.kind = PersonKind::oblivious;
    walker.wanted_mps = std::clamp(options.median_mps + options.sigma_mps * random_.normal(),
                                   options.slowest_mps, options.fastest_mps);
    walker.waits = walker.kind == PersonKind::threatening;
    const bool joins = !walkers_.empty() && !walker.waits && random_.uniform() < options.group_share;
    if (joins && walkers_.back().kind != PersonKind::threatening) walker.leader = walkers_.size() - 1;
    constexpr int tries = 100;
    for (int k = 0; k < tries; ++k) {
      const std::optional<Vec2> place_m = random_place();
      if (!place_m || (*place_m - map_from_base.position_m).norm() < from_robot_at_start_m) continue;
      walker.disc.position_m = *place_m;
      walker.goal_m = *place_m;
      walkers_.push_back(walker);
      break;
    }
  }
}

bool Walkers::is_free(const Vec2& place_m) const {
  return !disc_overlaps_obstacle(map_, place_m, options_.radius_m);
}

std::optional<Vec2> Walkers::random_place() {
  constexpr int tries = 100;
  for (int i = 0; i < tries; ++i) {
    const Vec2 in_grid_m = map_.resolution_m * Vec2(random_.uniform(0.0, map_.columns), 0.0) +
                           map_.resolution_m * Vec2(0.0, random_.uniform(0.0, map_.rows));
    const Vec2 place_m = map_.map_from_grid * in_grid_m;
    if (is_free(place_m)) return place_m;
  }
  return std::nullopt;
}

/// A free place in sight, so that the straight way leads there: through a door, perhaps.
void Walkers::choose_goal(Walker& walker) {
  walker.goal_time = longest_way;
  walker.held_up = Duration::zero();
  if (walker.leader) {
    walker.goal_m = walkers_[*walker.leader].goal_m;
    return;
  }
  constexpr int tries = 30;
  for (int i = 0; i < tries; ++i) {
    const std::optional<Vec2> place_m = random_place();
    if (!place_m || !is_in_sight(map_, walker.disc.position_m, *place_m)) continue;
    walker.goal_m = *place_m;
    return;
  }
}

/// A threatening person who waits steps out when the robot comes, stays in its way, and then walks on.
void Walkers::notice(Walker& walker, const Robot& robot) {
  if (!walker.waits) return;
  if ((robot.position_m - walker.disc.position_m).norm() > step_out_within_m) return;
  walker.waits = false;
  walker.goal_m = robot.position_m + ahead_of_robot_m * direction_of(robot.yaw_rad);
  walker.goal_time = in_the_way;
}

void Walkers::step(Duration by, const Pose2& map_from_base, std::span<const DiscState> things) {
  const double by_s = seconds(by);
  const Pose2 before = last_robot_.value_or(map_from_base);
  const Robot robot{map_from_base.position_m, (map_from_base.position_m - before.position_m) / by_s,
                    map_from_base.yaw_rad};
  last_robot_ = map_from_base;
  std::vector<Vec2> forces_mps2;
  for (std::size_t i = 0; i < walkers_.size(); ++i) {
    Walker& walker = walkers_[i];
    notice(walker, robot);
    walker.goal_time -= by;
    const bool is_there = (walker.goal_m - walker.disc.position_m).norm() <= arrived_m;
    const bool stays = walker.waits || (walker.kind == PersonKind::threatening && is_there);
    walker.held_up =
        walker.disc.velocity_mps.norm() < walking_mps && !stays ? walker.held_up + by : Duration::zero();
    const bool gives_up = walker.goal_time <= Duration::zero() || walker.held_up >= longest_hold_up;
    if (!walker.waits && (gives_up || (is_there && !stays))) choose_goal(walker);
    forces_mps2.push_back(force_mps2(i, robot, things));
  }
  std::vector<DiscState> solids(things.begin(), things.end());
  if (options_.robot_radius_m > options_.gives_way_m)
    solids.push_back(
        {.radius_m = options_.robot_radius_m - options_.gives_way_m, .position_m = robot.position_m});
  for (std::size_t i = 0; i < walkers_.size(); ++i) move(walkers_[i], forces_mps2[i], by_s, solids);
}

Vec2 Walkers::wall_force_mps2(const Vec2& position_m) const {
  const Cell at = map_.cell_at(position_m);
  const auto distance_m = [&](int column, int row) {
    return map_.contains({column, row}) ? field_.distance_m({column, row}) : 0.0;
  };
  if (!map_.contains(at)) return Vec2::Zero();
  const Vec2 rise(distance_m(at.column + 1, at.row) - distance_m(at.column - 1, at.row),
                  distance_m(at.column, at.row + 1) - distance_m(at.column, at.row - 1));
  if (rise.isZero()) return Vec2::Zero();
  const double room_m = std::max(0.0, field_.distance_m(at) - options_.radius_m);
  const Vec2 away = Pose2{Vec2::Zero(), map_.map_from_grid.yaw_rad} * rise.normalized();
  return wall_strength_mps2 * std::exp(-room_m / wall_range_m) * away;
}

Vec2 Walkers::force_mps2(std::size_t index, const Robot& robot, std::span<const DiscState> things) const {
  const Walker& walker = walkers_[index];
  const DiscState& self = walker.disc;
  Vec2 force_mps2 = goal_force_mps2(walker) + wall_force_mps2(self.position_m);
  for (std::size_t i = 0; i < walkers_.size(); ++i) {
    const DiscState& other = walkers_[i].disc;
    if (i != index)
      force_mps2 +=
          social_force_mps2(self.position_m, self.velocity_mps, other.position_m, other.velocity_mps);
  }
  for (const DiscState& thing : things)
    force_mps2 += social_force_mps2(self.position_m, self.velocity_mps, thing.position_m, thing.velocity_mps);
  if (walker.kind == PersonKind::ordinary)
    force_mps2 += social_force_mps2(self.position_m, self.velocity_mps, robot.position_m, robot.velocity_mps);
  return force_mps2;
}

/// Does the step lead neither into a wall nor farther into something solid?
bool Walkers::is_passable(const DiscState& self, const Vec2& place_m,
                          std::span<const DiscState> solids) const {
  const auto leads_into = [&](const DiscState& solid) {
    const double then_m = (place_m - solid.position_m).norm();
    return then_m < self.radius_m + solid.radius_m && then_m < (self.position_m - solid.position_m).norm();
  };
  return is_free(place_m) && std::ranges::none_of(solids, leads_into);
}

/// Nobody walks through a wall or a thing: where the way ends at one, the part along it is left, else that
/// along the grid.
void Walkers::move(Walker& walker, const Vec2& force_mps2, double by_s,
                   std::span<const DiscState> solids) const {
  DiscState& disc = walker.disc;
  const double size_mps2 = force_mps2.norm();
  const double share =
      size_mps2 > options_.max_acceleration_mps2 ? options_.max_acceleration_mps2 / size_mps2 : 1.0;
  Vec2 velocity_mps = disc.velocity_mps + share * by_s * force_mps2;
  const double speed_mps = velocity_mps.norm();
  if (speed_mps > options_.fastest_mps) velocity_mps *= options_.fastest_mps / speed_mps;
  if (walker.waits) velocity_mps = Vec2::Zero();
  const auto leads_on = [&](const Vec2& part_mps) {
    return is_passable(disc, disc.position_m + by_s * part_mps, solids);
  };
  if (!leads_on(velocity_mps)) {
    const Vec2 away = wall_force_mps2(disc.position_m).normalized();
    const std::array parts_mps{along_wall(away, velocity_mps),
                               along_wall(away_from_nearest(disc, solids), velocity_mps),
                               Vec2(velocity_mps.x(), 0.0), Vec2(0.0, velocity_mps.y())};
    const auto part = std::ranges::find_if(parts_mps, leads_on);
    velocity_mps = part == parts_mps.end() ? Vec2(Vec2::Zero()) : *part;
  }
  disc.velocity_mps = velocity_mps;
  disc.position_m += by_s * velocity_mps;
  disc.walked_m += by_s * velocity_mps.norm();
  if (velocity_mps.norm() > walking_mps) disc.heading_rad = heading_of(velocity_mps);
}

}  // namespace lodestar
