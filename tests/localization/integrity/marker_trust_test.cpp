#include "localization/integrity/marker_trust.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>

#include "localization/filter/pose_filter.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

/// A round trip of 12 m under eight markers, each seen alone or with the next, with a filter that gets the
/// true robot's fixes. Fixes have noise of their own, and every marker has a survey error.
struct RoundTrip {
  static constexpr int markers = 8;
  static constexpr double radius_m = 2.0;
  static constexpr double sight_m = 1.0;
  static constexpr double track_m = 0.4;

  std::array<Vec2, markers> surveyed;
  std::array<Vec2, markers> installed;
  std::array<double, markers> turned{};
  PoseFilter filter{options()};
  MarkerTrust trust;
  Pose2 truth{{radius_m, 0.0}, radians(90.0)};
  WheelTravel travel;
  Random random;
  int relocations = 0;

  static PoseFilterOptions options() {
    PoseFilterOptions options;
    options.track_width_m = track_m;
    options.fix_sigma_floor_m = 0.003;
    return options;
  }

  explicit RoundTrip(std::uint64_t seed) : random(seed) {
    for (std::size_t i = 0; i < markers; ++i) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / markers;
      surveyed.at(i) = radius_m * Vec2(std::cos(angle), std::sin(angle));
      installed.at(i) = surveyed.at(i) + 0.002 * Vec2(random.normal(), random.normal());
    }
  }

  /// A fix by one marker, off by the marker's displacement.
  PlanarFix fix_by(std::size_t i) {
    // The robot sees the marker from its true pose, and computes with the surveyed one of the marker.
    const Pose2 map_from_installed{installed.at(i), turned.at(i)};
    const Pose2 map_from_surveyed{surveyed.at(i), 0.0};
    PlanarFix fix{.stamp = travel.stamp,
                  .map_from_base = map_from_surveyed * inverse(map_from_installed) * truth,
                  .covariance = Vec3(1.6e-5, 1.6e-5, 4e-6).asDiagonal(),
                  .ids = {static_cast<int>(i)}};
    fix.map_from_base.position_m += 0.004 * Vec2(random.normal(), random.normal());
    fix.map_from_base.yaw_rad = wrap_angle(fix.map_from_base.yaw_rad + 0.002 * random.normal());
    return fix;
  }

  void see() {
    for (std::size_t i = 0; i < markers; ++i) {
      const int id = static_cast<int>(i);
      if ((installed.at(i) - truth.position_m).norm() > sight_m || !trust.trusts(id)) continue;
      const PlanarFix fix = fix_by(i);
      const std::optional<FixExpectation> expected = filter.expectation(fix);
      const FixOutcome outcome = filter.add_fix(fix);
      if (outcome == FixOutcome::accepted) trust.add_agreement(std::array{id});
      if (outcome == FixOutcome::relocated) {
        ++relocations;
        trust.estimate_moved();
      }
      if (outcome == FixOutcome::refused_gate) {
        trust.add_contradiction({.id = id,
                                 .marker_in_map = surveyed.at(i),
                                 .map_from_base_by_marker = fix.map_from_base,
                                 .map_from_base_expected = expected->map_from_base,
                                 .squared_distance = expected->squared_distance});
      }
    }
  }

  void drive(double way_m) {
    constexpr double step_m = 0.01;
    for (int i = 0; i < static_cast<int>(way_m / step_m); ++i) {
      const double left = step_m * (1.0 - 0.5 * track_m / radius_m) + 0.003 * 0.1 * random.normal();
      const double right = step_m * (1.0 + 0.5 * track_m / radius_m) + 0.003 * 0.1 * random.normal();
      truth = rolled(truth, left, right, track_m);
      travel.stamp += std::chrono::milliseconds(20);
      travel.left_m += step_m * (1.0 - 0.5 * track_m / radius_m);
      travel.right_m += step_m * (1.0 + 0.5 * track_m / radius_m);
      filter.add_travel(travel);
      if (i % 3 == 0) see();
    }
  }

  [[nodiscard]] double error_m() const {
    return (filter.estimate()->map_from_base.position_m - truth.position_m).norm();
  }
};

TEST(MarkerTrust, accuses_no_healthy_marker) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    RoundTrip trip(seed);
    trip.drive(26.0);
    EXPECT_TRUE(trip.trust.distrusted().empty()) << "seed " << seed;
  }
}

TEST(MarkerTrust, names_a_marker_that_was_moved_and_by_how_much) {
  int within_four_sigmas = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    RoundTrip trip(seed);
    trip.drive(7.0);
    Random random(seed + 1000);
    const double way_m = random.uniform(0.05, 0.5);
    const double direction = random.uniform(-3.1, 3.1);
    const Vec2 moved = way_m * Vec2(std::cos(direction), std::sin(direction));
    const auto which = static_cast<std::size_t>(random.below(RoundTrip::markers));
    trip.installed.at(which) += moved;
    trip.drive(26.0);
    const std::vector<DistrustedMarker> distrusted = trip.trust.distrusted();
    ASSERT_EQ(distrusted.size(), 1U) << "seed " << seed << ", " << way_m << " m";
    EXPECT_EQ(distrusted.front().id, static_cast<int>(which)) << "seed " << seed;
    const double off_m = (distrusted.front().offset_m - moved).norm();
    EXPECT_LT(off_m, 0.02) << "seed " << seed;
    EXPECT_LT(distrusted.front().sigma_m, 0.02) << "seed " << seed;
    within_four_sigmas += off_m < 4.0 * distrusted.front().sigma_m ? 1 : 0;
    EXPECT_LT(trip.error_m(), 0.03) << "seed " << seed;
  }
  EXPECT_GE(within_four_sigmas, 57) << "of 60";
}

TEST(MarkerTrust, names_a_marker_that_was_turned) {
  RoundTrip trip(5);
  trip.turned[3] = radians(8.0);
  trip.drive(26.0);
  ASSERT_EQ(trip.trust.distrusted().size(), 1U);
  EXPECT_EQ(trip.trust.distrusted().front().id, 3);
  EXPECT_NEAR(trip.trust.distrusted().front().turn_rad, radians(8.0), radians(1.0));
}

TEST(MarkerTrust, blames_the_wheels_for_a_slip_and_people_for_a_lift) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    RoundTrip trip(seed);
    trip.drive(8.0);
    Random random(seed + 2000);
    const double way_m = seed % 2 == 0 ? random.uniform(0.05, 0.2) : 1.2;
    trip.truth.position_m += way_m * Vec2(std::cos(trip.truth.yaw_rad), std::sin(trip.truth.yaw_rad));
    trip.drive(14.0);
    EXPECT_TRUE(trip.trust.distrusted().empty()) << "seed " << seed << ", " << way_m << " m";
    EXPECT_LT(trip.error_m(), 0.03) << "seed " << seed;
  }
}

TEST(MarkerTrust, does_not_judge_by_one_witness) {
  MarkerTrust trust;
  trust.add_agreement(std::array{1});
  const MarkerSighting sighting{.id = 2,
                                .marker_in_map = Vec2(1.0, 1.0),
                                .map_from_base_by_marker = {Vec2(0.3, 0.0), 0.0},
                                .map_from_base_expected = {Vec2::Zero(), 0.0},
                                .squared_distance = 100.0};
  for (int i = 0; i < 50; ++i) {
    trust.add_contradiction(sighting);
    trust.add_agreement(std::array{1});
  }
  EXPECT_TRUE(trust.trusts(2));
  trust.add_agreement(std::array{3});
  for (int i = 0; i < 6; ++i) trust.add_contradiction(sighting);
  EXPECT_TRUE(trust.trusts(2)) << "not confirmed yet";
  trust.add_agreement(std::array{1, 3});
  EXPECT_FALSE(trust.trusts(2));
  EXPECT_LT((trust.distrusted().front().offset_m - Vec2(-0.3, 0.0)).norm(), 1e-12);
}

}  // namespace
}  // namespace lodestar
