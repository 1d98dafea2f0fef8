#include "control/protective_field.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "control/field_release.hpp"
#include "control/hidden_corners.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

constexpr double radius_m = 0.25;
constexpr double age_s = 0.13;  // a scan's turn and its delivery
const BodyVelocity full{0.6, 0.0};

ProtectiveField disc_field() {
  return ProtectiveField(RobotShape(radius_m));
}

FieldHit hit(double x_m, double y_m, Presence presence) {
  return {{x_m, y_m}, age_s, presence};
}

TEST(ProtectiveField, NothingAroundLimitsNothing) {
  const FieldLimit limit = disc_field().limit({}, full, full);
  EXPECT_EQ(limit.share, 1.0);
  EXPECT_FALSE(limit.reason);
}

/// With T = 0.27 s, b = 1.5 m/s2 and V = 2.0 m/s full speed needs 1.62 m, plus 0.25 m for feet.
TEST(ProtectiveField, APersonAheadIsKeptAsFarAsTheFormulaSays) {
  const double needs_m = radius_m + 0.25 + 1.62 - age_s * full.forward_mps;  // it has come nearer since
  const std::vector<FieldHit> near{hit(needs_m - 0.03, 0.0, Presence::person)};
  const std::vector<FieldHit> far{hit(needs_m + 0.05, 0.0, Presence::person)};
  EXPECT_LT(disc_field().limit(near, full, full).share, 1.0);
  EXPECT_EQ(disc_field().limit(near, full, full).reason, FieldReason::person_near);
  EXPECT_EQ(disc_field().limit(far, full, full).share, 1.0);
}

TEST(ProtectiveField, NobodyNearerThanTheirReactionLetsItMove) {
  const std::vector<FieldHit> hits{hit(0.0, radius_m + 0.7, Presence::person)};
  EXPECT_EQ(disc_field().limit(hits, {}, full).share, 0.0);
}

/// A gap that leaves 11 cm a side, seen by the oldest beam of a rotating scanner, with 3 cm of range noise.
TEST(ProtectiveField, StandingThingsArePassedWith11Centimetres) {
  std::vector<FieldHit> hits;
  for (double x_m = -1.0; x_m <= 1.0; x_m += 0.03) {
    hits.push_back({{x_m, radius_m + 0.08}, 0.23, Presence::standing});
    hits.push_back({{x_m, -radius_m - 0.11}, 0.23, Presence::standing});
  }
  const BodyVelocity creeping{0.11, 0.0};
  EXPECT_GT(disc_field().limit(hits, creeping, full).share * full.forward_mps, 0.1);
  EXPECT_EQ(disc_field().limit(hits, creeping, full).reason, FieldReason::obstacle_ahead);
  for (FieldHit& person : hits) person.presence = Presence::person;
  EXPECT_EQ(disc_field().limit(hits, creeping, full).share, 0.0);
}

TEST(ProtectiveField, WhatIsMappedAheadStopsItAndLetsItLeave) {
  for (const Presence presence : {Presence::mapped, Presence::standing}) {
    const std::vector<FieldHit> hits{hit(radius_m + 0.005, 0.0, presence)};  // nearer than the margin
    EXPECT_EQ(disc_field().limit(hits, {}, {0.1, 0.0}).share, 0.0);
    EXPECT_EQ(disc_field().limit(hits, {}, {-0.1, 0.0}).share, 1.0);
    EXPECT_EQ(disc_field().limit(hits, {}, {0.0, 0.45}).share, 1.0);  // its rim at 0.11 m/s
  }
}

/// Its rim rubs along whoever leans on it, and no base turns exactly on the spot.
TEST(ProtectiveField, ADiscDoesNotTurnWhileSomeoneMayTouchIt) {
  const std::vector<FieldHit> near{hit(0.0, radius_m + 0.6, Presence::person)};
  EXPECT_EQ(disc_field().limit(near, {}, {0.0, 0.5}).share, 0.0);
  const std::vector<FieldHit> far{hit(0.0, radius_m + 1.5, Presence::person)};
  EXPECT_EQ(disc_field().limit(far, {}, {0.0, 0.5}).share, 1.0);
}

/// Who talks in a group sways for minutes: a robot driven up to the last centimetre was held there as long.
TEST(ProtectiveField, BeforeWhoStaysItStopsWhereItCanTurnAway) {
  const BodyVelocity creeping{0.05, 0.0};
  const BodyVelocity turning{0.0, 0.3};
  const auto turn_where_it_stops = [&](bool stays) {
    double ahead_m = 3.0;
    const auto allowed = [&](const BodyVelocity& measured, const BodyVelocity& wanted) {
      FieldHit person = hit(ahead_m, 0.1, Presence::person);
      person.stays = stays;
      return disc_field().limit(std::vector{person}, measured, wanted).share;
    };
    while (allowed(creeping, creeping) > 0.0) ahead_m -= 0.005;
    ahead_m -= 0.03;  // they sway
    return allowed({}, turning);
  };
  EXPECT_GT(turn_where_it_stops(true), 0.7);
  EXPECT_LT(turn_where_it_stops(false), 0.2) << "how it would be else";
}

TEST(ProtectiveField, WhoStaysBesideTheWayHoldsItNoSooner) {
  FieldHit person = hit(0.5, radius_m + 1.3, Presence::person);
  const double share = disc_field().limit(std::vector{person}, full, full).share;
  person.stays = true;
  EXPECT_EQ(disc_field().limit(std::vector{person}, full, full).share, share);
}

/// The body around them: they are passed 25 cm off, beside a wall too, and left from wherever they are.
TEST(ProtectiveField, StandingLegsKeepRoomForTheirBody) {
  std::vector<FieldHit> hits{hit(0.3, 0.32, Presence::legs)};  // 19 cm off
  EXPECT_LT(disc_field().limit(hits, {}, {0.1, 0.0}).share, 1.0);
  EXPECT_EQ(disc_field().limit(hits, {}, {-0.1, 0.0}).share, 1.0);
  hits.push_back(hit(0.0, -radius_m - 0.005, Presence::mapped));
  EXPECT_LT(disc_field().limit(hits, {}, {0.1, 0.0}).share, 1.0);
  const std::vector<FieldHit> aside{hit(0.3, radius_m + 0.27, Presence::legs)};
  EXPECT_EQ(disc_field().limit(aside, {}, {0.1, 0.0}).share, 1.0);
}

/// The corner of a long robot swings 0.5 m out.
TEST(ProtectiveField, AFootprintDoesNotTurnIntoWhatIsBesideIt) {
  const Footprint footprint({{-0.5, -0.2}, {0.5, -0.2}, {0.5, 0.2}, {-0.5, 0.2}});
  const ProtectiveField field{RobotShape(footprint)};
  const std::vector<FieldHit> hits{hit(0.44, 0.26, Presence::mapped)};
  EXPECT_LT(field.limit(hits, {}, {0.0, 1.0}).share, 0.7);
  EXPECT_EQ(field.limit(hits, {}, {0.0, -1.0}).reason.has_value(), false);
  EXPECT_EQ(field.limit(hits, full, full).share, 1.0);
}

TEST(ProtectiveField, WithoutAScanThereIsNoSpeed) {
  const Stamp seen(std::chrono::seconds(5));
  const std::optional<FieldScan> scan{FieldScan{.newest = seen, .points = {}}};
  const auto limit_after = [&](int ms) {
    return disc_field().limit(scan, seen + std::chrono::milliseconds(ms), {}, full, full);
  };
  EXPECT_EQ(limit_after(300).share, 1.0);
  EXPECT_EQ(limit_after(301).share, 0.0);
  EXPECT_EQ(limit_after(301).reason, FieldReason::no_scan);
  EXPECT_EQ(disc_field().limit(std::nullopt, seen, {}, full, full).reason, FieldReason::no_scan);
}

TEST(ProtectiveField, AtAHiddenCornerItIsSlowButNotStuck) {
  const std::vector<FieldHit> hits{hit(0.4, 0.4, Presence::hidden)};
  const FieldLimit limit = disc_field().limit(hits, {0.3, 0.0}, full);
  EXPECT_LE(limit.share * full.forward_mps, 0.36);
  EXPECT_GT(limit.share * full.forward_mps, 0.3);
  EXPECT_EQ(limit.reason, FieldReason::hidden_corner);
}

/// With the nearest hit a little ahead, as along any wall.
TEST(ProtectiveField, BesideAWallItGoesOnHoweverNear) {
  std::vector<FieldHit> hits;
  for (double x_m = -1.0; x_m <= 1.0; x_m += 0.013)
    hits.push_back({{x_m, radius_m + 0.004 + 0.0001 * std::abs(x_m - 0.02)}, 0.1, Presence::mapped});
  const BodyVelocity creeping{0.1, 0.0};
  EXPECT_EQ(disc_field().limit(hits, creeping, creeping).share, 1.0);
}

/// Noise makes the room look smaller than it is, now for this hit and then for that one.
TEST(ProtectiveField, WhatStandsIsNotTouchedByGettingUsedToIt) {
  const BodyVelocity creeping{0.1, 0.0};
  const std::vector<FieldHit> hits{hit(0.0, radius_m - 0.005, Presence::standing),
                                   hit(radius_m + 0.012, 0.0, Presence::standing)};
  EXPECT_LT(disc_field().limit(hits, creeping, creeping).share, 0.2);
  EXPECT_EQ(disc_field().limit(hits, {}, {-0.1, 0.0}).share, 1.0);
}

/// Where it has come as near to something that looks like legs only from there, it gets away again.
TEST(ProtectiveField, WithLegsInReachOfABodyItComesNoNearer) {
  for (const double distance_m : {0.02, 0.15}) {
    const std::vector<FieldHit> near{hit(radius_m + distance_m, 0.0, Presence::legs)};
    EXPECT_EQ(disc_field().limit(near, {0.002, 0.1}, {0.0, 0.2}).share, 1.0);
    EXPECT_LT(disc_field().limit(near, {}, {0.01, 0.1}).share, 0.02);
    EXPECT_EQ(disc_field().limit(near, {}, {-0.1, 0.0}).share, 1.0);
  }
  const Footprint square({{-0.3, -0.3}, {0.3, -0.3}, {0.3, 0.3}, {-0.3, 0.3}});
  const std::vector<FieldHit> at_corner{hit(0.28, 0.35, Presence::legs)};
  EXPECT_LT(ProtectiveField{RobotShape(square)}.limit(at_corner, {}, {0.0, 0.2}).share, 0.3);
  const std::vector<FieldHit> beside{
      hit(0.0, radius_m + ProtectiveFieldOptions{}.body_margin_m + 0.01, Presence::legs)};
  EXPECT_EQ(disc_field().limit(beside, {0.1, 0.0}, {0.1, 0.0}).share, 1.0);
}

/// Straight past them in steps; true once they are behind.
bool passes_legs(double aside_m, double noise_m) {
  Random random(3);
  double ahead_m = 0.4;
  for (int step = 0; step < 1000 && ahead_m > -0.1; ++step) {
    const std::vector<FieldHit> hits{hit(ahead_m + noise_m * random.normal(),
                                         radius_m + aside_m + noise_m * random.normal(), Presence::legs)};
    ahead_m -= 0.02 * disc_field().limit(hits, {0.1, 0.0}, {0.1, 0.0}).share * 0.1;
  }
  return ahead_m <= -0.1;
}

/// A way is planned to keep 20 cm where none has more room: between that and what it would like to keep the
/// robot is not held.
TEST(ProtectiveField, LegsBesideAPlannedWayArePassed) {
  for (const double noise_m : {0.0, 0.001, 0.003}) {
    EXPECT_TRUE(passes_legs(0.225, noise_m)) << noise_m;
    EXPECT_TRUE(passes_legs(0.215, noise_m)) << noise_m;
    EXPECT_FALSE(passes_legs(0.18, noise_m)) << noise_m;
  }
}

/// What it has come up to, and then looks like legs: it drives on past what is beside it already.
TEST(ProtectiveField, LegsRightBesideItDoNotHoldIt) {
  for (const double ahead_m : {-0.03, -0.01, 0.0, 0.01, 0.03}) {
    const std::vector<FieldHit> beside{hit(ahead_m, radius_m + 0.18, Presence::legs)};
    EXPECT_EQ(disc_field().limit(beside, {0.1, 0.0}, {0.1, 0.0}).share, 1.0) << ahead_m;
  }
  const std::vector<FieldHit> ahead{hit(0.05, radius_m + 0.18, Presence::legs)};
  EXPECT_LT(disc_field().limit(ahead, {0.1, 0.0}, {0.1, 0.0}).share, 0.1);
}

/// From rest they are at the robot before it is at rest, however slowly it creeps or moves off; sooner than
/// someone who was there before it came.
TEST(ProtectiveField, BesideLegsThatWereSeenToComeItDoesNotEvenCreep) {
  const double body_m = ProtectiveFieldOptions{}.body_margin_m;
  for (const Presence presence : {Presence::legs, Presence::waiting}) {
    const std::vector<FieldHit> beside{hit(0.0, radius_m + body_m + 0.02, presence)};
    const double share = presence == Presence::legs ? 1.0 : 0.0;
    EXPECT_EQ(disc_field().limit(beside, {}, {0.1, 0.0}).share, share);
    EXPECT_EQ(disc_field().limit(beside, {}, {-0.1, 0.0}).share, share);
    const std::vector<FieldHit> near{hit(0.0, radius_m + body_m + 0.22, presence)};
    EXPECT_EQ(disc_field().limit(near, {}, {0.1, 0.0}).share < 1.0, presence == Presence::waiting);
    const std::vector<FieldHit> farther{hit(0.0, radius_m + body_m + 0.25, presence)};
    EXPECT_EQ(disc_field().limit(farther, {}, {0.1, 0.0}).share, 1.0);
  }
}

/// It comes up to them by itself, and the noise of five beams (7 mm) then takes them for nearer; that of the
/// wheels has it move while it turns.
TEST(ProtectiveField, BesideWhatItHasComeUpToItTurnsOnTheSpot) {
  const ProtectiveFieldOptions options;
  for (const auto& [presence, distance_m] : {std::pair(Presence::legs, options.body_margin_m),
                                             std::pair(Presence::standing, options.standing_margin_m)}) {
    for (const double noise_m : {-0.012, -0.009, -0.002, 0.0001, 0.003}) {
      for (const double rolls_mps : {-0.002, 0.0, 0.002}) {
        const std::vector<FieldHit> hits{hit(radius_m + distance_m + noise_m, 0.0, presence)};
        EXPECT_EQ(disc_field().limit(hits, {rolls_mps, 0.1}, {0.0, 0.1}).share, 1.0)
            << distance_m << " " << noise_m << " " << rolls_mps;
      }
    }
  }
}

/// However often it tries: neither the body around legs nor what stands is touched.
TEST(ProtectiveField, WhatIsBesideATurnIsNotReachedByItsSlack) {
  const ProtectiveFieldOptions options;
  for (const auto& [presence, begins_m, least_m] :
       {std::tuple(Presence::legs, options.body_margin_m, options.body_m),
        std::tuple(Presence::standing, options.standing_margin_m, options.least_standing_m)}) {
    double distance_m = begins_m;
    for (int step = 0; step < 5000; ++step) {
      const std::vector<FieldHit> hits{hit(radius_m + distance_m, 0.0, presence)};
      const BodyVelocity wanted{0.03, 0.1};
      distance_m -= 0.02 * disc_field().limit(hits, wanted, wanted).share * wanted.forward_mps;
    }
    EXPECT_GE(distance_m, least_m - 1e-6);
  }
}

/// A corner that comes into sight when it is too late for the speed: braking to rest would help nobody more.
TEST(ProtectiveField, AHiddenCornerNeverAsksForRest) {
  const double contact_mps = ProtectiveFieldOptions{}.hidden_contact_mps;
  std::vector<FieldHit> hits{hit(0.3, 0.1, Presence::hidden)};
  const FieldLimit limit = disc_field().limit(hits, full, full);
  EXPECT_NEAR(limit.share * full.forward_mps, contact_mps, 0.01);
  EXPECT_EQ(limit.reason, FieldReason::hidden_corner);
  const BodyVelocity slow{contact_mps, 0.0};
  EXPECT_EQ(disc_field().limit(hits, full, slow).share, 1.0);
  hits.push_back(hit(0.5, 0.1, Presence::person));
  EXPECT_EQ(disc_field().limit(hits, full, full).share, 0.0);
}

TEST(FieldRelease, FallsAtOnceAndRisesGentlyAfterAWhile) {
  FieldRelease release;
  const auto at = [](double s) { return Stamp(from_seconds(s)); };
  EXPECT_EQ(release.released_mps(at(0.0), FieldRelease::none_mps), FieldRelease::none_mps);
  EXPECT_EQ(release.released_mps(at(0.02), 0.1), 0.1);
  double before_mps = 0.1;
  for (double s = 0.04; s < 1.0; s += 0.02) {
    const double released_mps = release.released_mps(at(s), FieldRelease::none_mps);
    if (s < 0.31) {
      EXPECT_EQ(released_mps, 0.1) << s;
    }
    EXPECT_LE(released_mps, before_mps + 0.5 * 0.02 + 1e-9);
    before_mps = released_mps;
  }
  EXPECT_NEAR(before_mps, 0.1 + 0.5 * 0.66, 0.02);
}

/// Seen from the origin, a wall at x = 1 up to `top_m`, behind it another one at x = 4.
DeskewedScan wall_before_wall(double bottom_m, double top_m) {
  DeskewedScan scan;
  for (int i = -90; i <= 90; ++i) {
    const Vec2 way(std::cos(0.5 * radians(i)), std::sin(0.5 * radians(i)));
    const double height_m = way.y() / way.x();
    const double x_m = height_m > bottom_m && height_m < top_m ? 1.0 : 4.0;
    scan.rays.push_back({{}, Vec2::Zero(), way * (x_m / way.x()), Echo::hit});
  }
  return scan;
}

TEST(HiddenCorners, AWallHidesAPersonAtItsEnd) {
  const auto anywhere = [](const Vec2&) { return true; };
  const auto corners = hidden_corners(wall_before_wall(-2.0, 0.2), {}, anywhere);
  ASSERT_EQ(corners.size(), 1U);
  EXPECT_NEAR((corners.front().point_in_odom - Vec2(1.0, 0.2)).norm(), 0.0, 0.02);
  EXPECT_EQ(corners.front().presence, Presence::hidden);
}

TEST(HiddenCorners, ATableLegAndAMappedWallHideNobody) {
  const auto anywhere = [](const Vec2&) { return true; };
  EXPECT_TRUE(hidden_corners(wall_before_wall(0.0, 0.06), {}, anywhere).empty());
  const auto nowhere = [](const Vec2&) { return false; };
  EXPECT_TRUE(hidden_corners(wall_before_wall(-2.0, 0.2), {}, nowhere).empty());
}

}  // namespace
}  // namespace lodestar
