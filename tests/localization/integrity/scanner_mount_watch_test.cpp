#include "localization/integrity/scanner_mount_watch.hpp"

#include <gtest/gtest.h>

#include "tests/maps/cast_scan.hpp"

namespace lodestar {
namespace {

using testing::Disc;

constexpr double width_m = 22.0;
constexpr double depth_m = 10.0;

/// People who stand with their backs to the sides of a hall.
std::vector<Disc> along_the_sides(int people, Random& random) {
  std::vector<Disc> discs;
  for (int i = 0; i < people; ++i)
    discs.push_back({{random.uniform(3.0, width_m - 1.0), i % 2 == 0 ? 0.3 : depth_m - 0.3}, 0.25});
  return discs;
}

/// Drives along the middle of the hall, with exact poses.
ScannerMountWatch driven_along(const OccupancyMap& hall, const std::vector<Disc>& people, double turned_rad,
                               Random& random) {
  const ObstacleField field(hall);
  ScannerMountWatch watch;
  for (double x_m = 1.5; x_m < 20.0; x_m += 0.06) {
    const Pose2 believed{{x_m, 0.5 * depth_m}, 0.0};
    const Scan scan = testing::cast_scan(
        hall, people, Stamp(), [&](Stamp) { return Pose2{believed.position_m, turned_rad}; }, random);
    watch.add(scan, testing::poses_of(scan, believed), field);
  }
  return watch;
}

/// A map that was drawn without walls, or of a part of a site: nothing on it says where beams should end.
TEST(ScannerMountWatch, EstimatesNothingWhereTheMapHasNoWalls) {
  OccupancyMap hall = testing::walled_room(width_m, depth_m);
  for (const std::int8_t beside : {OccupancyMap::free, OccupancyMap::unknown}) {
    for (std::int8_t& cell : hall.cells)
      if (cell != OccupancyMap::free) cell = beside;
    for (int people = 10; people <= 30; people += 5) {
      Random random(static_cast<unsigned>(people));
      const ScannerMountWatch watch = driven_along(hall, along_the_sides(people, random), 0.0, random);
      EXPECT_FALSE(watch.turned_rad()) << people << " people: " << degrees(watch.turned_rad().value_or(0.0));
    }
  }
}

TEST(ScannerMountWatch, IsNotMisledByPeopleAlongTheWalls) {
  const OccupancyMap hall = testing::walled_room(width_m, depth_m);
  for (int people = 0; people <= 60; people += 10) {
    for (const double turned_deg : {0.0, 2.0, -2.0}) {
      Random random(static_cast<unsigned>(people));
      const ScannerMountWatch watch =
          driven_along(hall, along_the_sides(people, random), radians(turned_deg), random);
      ASSERT_TRUE(watch.turned_rad());
      EXPECT_NEAR(degrees(*watch.turned_rad()), turned_deg, 0.6) << people << " people";
      EXPECT_EQ(watch.is_turned(), turned_deg != 0.0) << people << " people, " << turned_deg;
    }
  }
}

}  // namespace
}  // namespace lodestar
