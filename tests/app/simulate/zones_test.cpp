#include <algorithm>
#include <gtest/gtest.h>

#include "app/navigation/navigation_setup.hpp"
#include "app/simulate/simulated_drive.hpp"

// Zones on the lab's map, and drives through the simulated lab that obey them, by the truth.
namespace lodestar {
namespace {

Site lab() {
  return load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
}

RunRecord driven(const Site& site, std::uint64_t seed) {
  return simulate_drive(site, {.camera = site.default_camera, .seed = seed, .goals = {site.goals.front()}});
}

struct Strip {
  double nearest_m = 1e9;    ///< from the robot's edge to the polygon
  double fastest_mps = 0.0;  ///< while any part of the robot is inside
  double fastest_elsewhere_mps = 0.0;
};

/// Speeds are measured over 0.5 s: the wheels slip by some per cent of their way in each step of 20 ms.
Strip measured(const RunRecord& run, const Polygon& corners_m, double radius_m) {
  constexpr Duration over = std::chrono::milliseconds(500);
  Strip strip;
  std::size_t before = 0;
  for (const TruePose& at : run.truth) {
    const double distance_m = distance_to(corners_m, at.map_from_base.position_m) - radius_m;
    strip.nearest_m = std::min(strip.nearest_m, distance_m);
    while (at.stamp - run.truth[before].stamp > over) ++before;
    const TruePose& then = run.truth[before];
    const double elapsed_s = seconds(at.stamp - then.stamp);
    if (elapsed_s < 0.5 * seconds(over)) continue;
    const double speed_mps = (at.map_from_base.position_m - then.map_from_base.position_m).norm() / elapsed_s;
    const bool was_inside = distance_to(corners_m, then.map_from_base.position_m) < radius_m;
    double& fastest_mps = was_inside && distance_m < 0.0 ? strip.fastest_mps : strip.fastest_elsewhere_mps;
    fastest_mps = std::max(fastest_mps, speed_mps);
  }
  return strip;
}

TEST(ZonesInTheLab, a_keep_out_on_the_usual_way_is_driven_around) {
  Site site = lab();
  const RunRecord usual = driven(site, 1);
  ASSERT_TRUE(usual.arrived());
  // In the middle of the usual way, where there is room beside it.
  const Vec2 middle_m = usual.truth[usual.truth.size() / 2].map_from_base.position_m;
  const Polygon corners_m{middle_m + Vec2(-0.2, -0.2), middle_m + Vec2(0.2, -0.2), middle_m + Vec2(0.0, 0.2)};
  EXPECT_LT(measured(usual, corners_m, site.robot.radius_m).nearest_m, 0.0);

  site.places.keep_out = {{"hole", corners_m}};
  const RunRecord around = driven(site, 1);
  EXPECT_TRUE(around.arrived());
  EXPECT_GT(measured(around, corners_m, site.robot.radius_m).nearest_m, 0.0);
}

TEST(ZonesInTheLab, a_speed_zone_is_never_driven_through_faster) {
  for (const double max_mps : {0.15, 0.3}) {
    Site site = lab();
    const Polygon corners_m{{5.0, 0.0}, {8.0, 0.0}, {8.0, 7.5}, {5.0, 7.5}};
    site.places.speed_zones = {{"ward", corners_m, max_mps}};
    for (const std::uint64_t seed : {1U, 2U}) {
      const RunRecord run = driven(site, seed);
      const Strip strip = measured(run, corners_m, site.robot.radius_m);
      EXPECT_TRUE(run.arrived()) << seed;
      EXPECT_LE(strip.fastest_mps, max_mps) << seed;
      EXPECT_GT(strip.fastest_mps, 0.95 * max_mps) << seed;
      EXPECT_GT(strip.fastest_elsewhere_mps, 0.55) << seed;
    }
  }
}

/// At 0.05 m/s the way takes some 280 s, where 180 s would be enough for a robot that is stuck.
TEST(ZonesInTheLab, a_robot_that_is_slow_all_the_way_is_not_taken_for_stuck) {
  Site site = lab();
  site.places.speed_zones = {{"all", {{0.0, 0.0}, {16.0, 0.0}, {16.0, 8.0}, {0.0, 8.0}}, 0.05}};
  const RunRecord run = driven(site, 1);
  EXPECT_TRUE(run.arrived()) << run.goals.front().failure;
  EXPECT_GT(run.goals.front().travel_time, std::chrono::seconds(200));
}

}  // namespace
}  // namespace lodestar
