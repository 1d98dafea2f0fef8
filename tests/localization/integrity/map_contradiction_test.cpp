#include "localization/integrity/map_contradiction.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "maps/distance_field.hpp"
#include "maps/map_file.hpp"

#include "tests/maps/cast_scan.hpp"

namespace lodestar {
namespace {

using testing::cast_scan;
using testing::poses_of;

const PoseSigmas sigmas{.position_m = 0.003, .heading_rad = radians(0.1), .range_m = 0.01};

OccupancyMap lab() {
  return load_map(std::string(LODESTAR_SOURCE_DIR) + "/sites/lab/map.yaml").map;
}

Pose2 random_pose(const OccupancyMap& map, const DistanceField& field, Random& random) {
  for (;;) {
    const Vec2 at(random.uniform(0.0, 15.3), random.uniform(0.0, 7.5));
    if (map.contains(map.cell_at(at)) && field.distance_m(map.cell_at(at)) > 0.3)
      return {at, random.uniform(-3.1, 3.1)};
  }
}

/// Hides a share of the beams behind unknown things, in runs of 6 to 30 degrees.
void hide(Scan& scan, double share, Random& random) {
  const std::size_t beams = scan.beams.size();
  std::vector<bool> hidden(beams, false);
  std::size_t count = 0;
  while (static_cast<double>(count) < share * static_cast<double>(beams)) {
    const auto width =
        static_cast<std::size_t>(random.uniform(6.0, 30.0) / 360.0 * static_cast<double>(beams));
    const std::size_t first = random.below(beams);
    const double nearer = random.uniform(0.2, 0.9);
    for (std::size_t k = 0; k < width; ++k) {
      const std::size_t i = (first + k) % beams;
      if (hidden[i]) continue;
      hidden[i] = true;
      ++count;
      scan.beams[i].range_m *= nearer;
    }
  }
}

struct Off {
  double by_m = 0.0;
  double by_rad = 0.0;
};

/// Share of random places in which scans from there alarm at a pose that is off.
double alarms(const OccupancyMap& map, Off off, double hidden_share, int places, std::uint64_t seed) {
  const DistanceField field(map);
  Random random(seed);
  int count = 0;
  for (int i = 0; i < places; ++i) {
    const Pose2 truth = random_pose(map, field, random);
    const double direction_rad = random.uniform(-3.1, 3.1);
    const Pose2 believed{truth.position_m +
                             off.by_m * Vec2(std::cos(direction_rad), std::sin(direction_rad)) +
                             sigmas.position_m * Vec2(random.normal(), random.normal()),
                         truth.yaw_rad + (random.uniform() < 0.5 ? -1.0 : 1.0) * off.by_rad +
                             sigmas.heading_rad * random.normal()};
    MapContradiction contradiction;
    const Random things = random.stream(1);
    for (int k = 0; k < 5; ++k) {
      Scan scan = cast_scan(map, {}, Stamp{}, [&](Stamp) { return truth; }, random, {.beams = 720});
      Random same_things = things;
      hide(scan, hidden_share, same_things);
      contradiction.update(scan, poses_of(scan, believed), map, sigmas);
    }
    count += contradiction.alarm() ? 1 : 0;
  }
  return static_cast<double>(count) / places;
}

struct Wanted {
  double hidden_share = 0.0;
  double aside = 0.0;   ///< share of places in which 10 cm are noticed
  double turned = 0.0;  ///< and 3 degrees
};

TEST(MapContradiction, notices_most_poses_that_are_10_cm_or_3_degrees_off_and_believes_the_right_ones) {
  const OccupancyMap map = lab();
  std::string figures;
  for (const auto& [hidden, least_aside, least_turned] :
       {Wanted{0.0, 0.88, 0.94}, Wanted{0.3, 0.85, 0.90}, Wanted{0.6, 0.72, 0.82}}) {
    const double right = alarms(map, {}, hidden, 2000, 11);
    const double aside = alarms(map, {.by_m = 0.1}, hidden, 200, 12);
    const double turned = alarms(map, {.by_rad = radians(3.0)}, hidden, 200, 13);
    figures += fmt::format("{:.0f} % hidden: right {:.2f} %, 10 cm {:.1f} %, 3 degrees {:.1f} %\n",
                           100.0 * hidden, 100.0 * right, 100.0 * aside, 100.0 * turned);
    EXPECT_LE(right, 0.001) << figures;
    EXPECT_GE(aside, least_aside) << figures;
    EXPECT_GE(turned, least_turned) << figures;
  }
  RecordProperty("figures", figures);
}

/// A room of 8 m x 6 m; what the map has and the world has not lengthens beams in one or two sectors.
TEST(MapContradiction, takes_opened_doors_and_removed_furniture_for_no_alarm) {
  const OccupancyMap world = testing::walled_room(8.0, 6.0);
  OccupancyMap map = world;
  testing::put_box(map, {5.0, 3.5}, {5.6, 4.3});
  testing::put_box(map, {2.0, 0.6}, {3.0, 0.9});
  MapContradiction contradiction;
  Random random(5);
  const Pose2 pose{{2.5, 3.0}, 0.3};
  for (int i = 0; i < 10; ++i) {
    const Scan scan = cast_scan(world, {}, Stamp{}, [&](Stamp) { return pose; }, random);
    contradiction.update(scan, poses_of(scan, pose), map, sigmas);
    EXPECT_EQ(contradiction.sectors(), 2);
    EXPECT_FALSE(contradiction.alarm());
  }
  testing::put_box(map, {2.0, 5.0}, {2.4, 5.2});
  for (int i = 0; i < 4; ++i) {
    const Scan scan = cast_scan(world, {}, Stamp{}, [&](Stamp) { return pose; }, random);
    contradiction.update(scan, poses_of(scan, pose), map, sigmas);
    EXPECT_EQ(contradiction.sectors(), 3);
    EXPECT_EQ(contradiction.alarm(), i == 3) << "four scans of five";
  }
  contradiction.reset();
  EXPECT_FALSE(contradiction.alarm());
}

TEST(MapContradiction, counts_what_a_beam_passes_before_its_slack) {
  OccupancyMap map = testing::walled_room(4.0, 4.0);
  testing::put_box(map, {2.0, 0.0}, {2.049, 3.9});
  EXPECT_NEAR(wall_passed_m(map, {1.0, 2.02}, 0.0, 1.5, 0.12), 0.05, 1e-9);
  EXPECT_NEAR(wall_passed_m(map, {1.0, 2.02}, 0.0, 1.14, 0.12), 0.02, 1e-9);
  EXPECT_EQ(wall_passed_m(map, {1.0, 2.02}, 0.0, 1.1, 0.12), 0.0);
  EXPECT_EQ(wall_passed_m(map, {1.0, 2.02}, 0.0, 0.1, 0.12), 0.0);
}

}  // namespace
}  // namespace lodestar
