#include <gtest/gtest.h>

#include "tests/control/field_world.hpp"

// The rule's promise, by simulation from truth: nobody who walks at 2 m/s or less is touched by a robot that
// moves.
namespace lodestar {
namespace {

constexpr double robot_radius_m = 0.25;
constexpr double delivery_s = 0.03;

struct Outcome {
  int contacts_moving = 0;
  double way_m = 0.0;
};

/// People who come from 4 to 7 m away and go through the robot's surroundings, blind to it, half of them
/// aiming at where it will be; they change direction at random.
std::vector<Walker> crowd(Random& random) {
  std::vector<Walker> walkers(1 + random.below(4));
  for (Walker& walker : walkers) {
    const double bearing_rad = random.uniform(-3.14, 3.14);
    walker.at_m = random.uniform(4.0, 7.0) * Vec2(std::cos(bearing_rad), std::sin(bearing_rad));
    const Vec2 aim = Vec2(random.uniform(-0.5, 4.0), random.uniform(-1.0, 1.0)) - walker.at_m;
    walker.velocity_mps = random.uniform(0.3, 2.0) * aim.normalized();
  }
  return walkers;
}

void walk(std::vector<Walker>& walkers, Random& random) {
  for (Walker& walker : walkers) {
    walker.at_m += ToyBase::tick_s * walker.velocity_mps;
    if (random.uniform() > ToyBase::tick_s) continue;  // once a second
    const double speed_mps = random.uniform(0.3, 2.0);
    const double heading_rad = random.uniform(-3.14, 3.14);
    walker.velocity_mps = speed_mps * Vec2(std::cos(heading_rad), std::sin(heading_rad));
  }
}

FieldScan scan_of(const std::vector<Walker>& walkers, const Pose2& pose, double now_s) {
  FieldScan scan{.newest = Stamp(from_seconds(now_s)), .points = {}};
  for (const Walker& walker : walkers)
    add_outline(scan.points, walker, pose.position_m, scan.newest, Presence::person);
  return scan;
}

/// 8 s at 200 Hz, controlled at 50 Hz, scanned at 10 Hz.
Outcome drive(std::uint64_t seed, const ProtectiveFieldOptions& options, bool is_protected) {
  Random random(seed);
  std::vector<Walker> walkers = crowd(random);
  const BodyVelocity wanted{random.uniform(0.3, 0.6), random.uniform(-0.6, 0.6)};
  const ProtectiveField field(RobotShape(robot_radius_m), options);
  FieldRelease release;
  ToyBase base(options.response_s, options.deceleration_mps2);
  BodyVelocity command;
  std::optional<Delivery> on_its_way;
  std::optional<FieldScan> newest;
  Outcome outcome;
  std::vector<bool> touched(walkers.size(), false);
  for (int tick = 0; tick < 1600; ++tick) {
    const double now_s = 1.0 + tick * ToyBase::tick_s;
    if (tick % 20 == 0) on_its_way = {now_s + delivery_s, scan_of(walkers, base.pose, now_s)};
    if (on_its_way && now_s >= on_its_way->at_s - 1e-9)
      newest = std::exchange(on_its_way, std::nullopt)->scan;
    if (tick % 4 == 0) {
      const Stamp now(from_seconds(now_s));
      const FieldLimit limit = field.limit(newest, now, base.pose, base.velocity, wanted);
      const double most_mps = release.released_mps(now, allowed_mps(limit, wanted, field.shape()));
      command = is_protected ? slowed_to(most_mps, wanted, field.shape()) : wanted;
    }
    base.tick(command);
    walk(walkers, random);
    outcome.way_m += ToyBase::tick_s * base.velocity.forward_mps;
    for (std::size_t i = 0; i < walkers.size(); ++i) {
      const bool touches =
          (walkers[i].at_m - base.pose.position_m).norm() < robot_radius_m + walkers[i].radius_m;
      if (touches && !touched[i] && base.velocity.forward_mps > 0.01) ++outcome.contacts_moving;
      touched[i] = touches;
    }
  }
  return outcome;
}

Outcome all_drives(std::uint64_t drives, const ProtectiveFieldOptions& options, bool is_protected) {
  Outcome sum;
  for (std::uint64_t seed = 1; seed <= drives; ++seed) {
    const Outcome outcome = drive(seed, options, is_protected);
    if (is_protected && outcome.contacts_moving > 0) ADD_FAILURE() << "touched while moving, seed " << seed;
    sum.contacts_moving += outcome.contacts_moving;
    sum.way_m += outcome.way_m;
  }
  return sum;
}

/// Also without the margin for swinging feet, which these discs do not have.
TEST(ProtectiveFieldProof, NobodyIsTouchedByAMovingRobot) {
  ProtectiveFieldOptions options;
  options.swing_m = 0.0;
  constexpr std::uint64_t drives = 3000;
  const Outcome sum = all_drives(drives, options, true);
  EXPECT_EQ(sum.contacts_moving, 0);
  EXPECT_GT(sum.way_m / drives, 0.5);  // the robot moves all the same
}

TEST(ProtectiveFieldProof, WithoutTheRulePeopleAreTouched) {
  const Outcome sum = all_drives(500, {}, false);
  EXPECT_GT(sum.contacts_moving, 50);
}

/// The speed of people is what it rests on: planned with a quarter of it, the robot touches them.
TEST(ProtectiveFieldProof, APlanWithSlowerPeopleTouchesThem) {
  ProtectiveFieldOptions slow_people;
  slow_people.swing_m = 0.0;
  slow_people.person_mps = 0.5;
  int contacts = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed)
    contacts += drive(seed, slow_people, true).contacts_moving;
  EXPECT_GT(contacts, 0);
}

}  // namespace
}  // namespace lodestar
