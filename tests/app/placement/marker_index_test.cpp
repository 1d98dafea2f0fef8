#include "app/placement/marker_index.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "maps/random.hpp"

namespace lodestar {
namespace {

MarkerRegistry scattered(Random& random) {
  MarkerRegistry registry;
  for (int id = 0; id < 300; ++id) {
    RegisteredMarker marker;
    marker.id = id;
    marker.position_m = {random.uniform(0.0, 20.0), random.uniform(0.0, 20.0), random.uniform(2.2, 3.0)};
    marker.yaw_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
    registry.markers.push_back(marker);
  }
  return registry;
}

/// Somewhere on the robot, looking up and as much as 15 degrees to a side.
Eigen::Isometry3d some_mount(Random& random) {
  const double turn_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
  const double tilt_rad = random.uniform(0.0, 15.0) * std::numbers::pi / 180.0;
  Eigen::Isometry3d mount = Eigen::Isometry3d::Identity();
  mount.translate(Vec3(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(0.2, 1.0)));
  mount.rotate(Eigen::AngleAxisd(turn_rad, Vec3::UnitZ()) * Eigen::AngleAxisd(tilt_rad, Vec3::UnitX()));
  return mount;
}

CameraModel wide_lens() {
  CameraModel camera{
      .width_px = 640, .height_px = 480, .fx_px = 320.0, .fy_px = 320.0, .cx_px = 319.5, .cy_px = 239.5};
  camera.distortion = Distortion::plumb_bob;
  camera.coefficients = {-0.06, 0.01, 0.0004, -0.0003};
  return camera;
}

bool sees_all_of(const CameraModel& camera, const Eigen::Isometry3d& map_from_camera,
                 const MarkerInMap& marker) {
  return std::ranges::all_of(marker.dots, [&](const Vec3& dot) {
    const std::optional<Vec2> pixel = camera.project(map_from_camera.inverse() * dot);
    return pixel && camera.contains(*pixel);
  });
}

TEST(MarkerIndex, no_marker_that_a_camera_sees_is_left_out_and_most_of_the_others_are) {
  Random random(7);
  const CameraModel camera = wide_lens();
  int seen = 0;
  std::size_t asked = 0;
  for (int i = 0; i < 300; ++i) {
    const MarkerRegistry registry = scattered(random);
    const Eigen::Isometry3d mount = some_mount(random);
    const std::optional<double> reach_m = sight_reach_m(camera, mount, 3.0);
    ASSERT_TRUE(reach_m);
    const MarkerIndex all(registry, std::nullopt);
    const MarkerIndex near(registry, reach_m);
    const Vec2 place(random.uniform(0.0, 20.0), random.uniform(0.0, 20.0));
    const Pose2 map_from_base{place, random.uniform(-std::numbers::pi, std::numbers::pi)};
    const std::vector<const MarkerInMap*> found = near.about(place);
    asked += found.size();
    for (const MarkerInMap* marker : all.about(place)) {
      if (!sees_all_of(camera, lifted(map_from_base) * mount, *marker)) continue;
      ++seen;
      EXPECT_TRUE(std::ranges::any_of(
          found, [&](const MarkerInMap* other) { return other->middle == marker->middle; }));
    }
  }
  EXPECT_GT(seen, 300);
  EXPECT_LT(asked, 300U * 300U * 3 / 4);
}

TEST(MarkerIndex, gives_the_registrys_order) {
  MarkerRegistry registry;
  for (const double x_m : {3.0, 0.1, 1.9, 0.5}) {
    RegisteredMarker marker;
    marker.position_m = {x_m, 0.0, 2.6};
    registry.markers.push_back(marker);
  }
  const MarkerIndex index(registry, 1.0);
  const std::vector<const MarkerInMap*> found = index.about({0.6, 0.0});
  ASSERT_EQ(found.size(), 3U);
  EXPECT_LT(found[0]->middle.x(), found[1]->middle.x());
  EXPECT_GT(found[1]->middle.x(), found[2]->middle.x());
}

TEST(MarkerIndex, a_camera_that_looks_to_the_horizon_has_no_reach) {
  CameraModel fisheye = wide_lens();
  fisheye.distortion = Distortion::none;
  fisheye.coefficients = {};
  fisheye.fx_px = fisheye.fy_px = 40.0;
  EXPECT_EQ(sight_reach_m(fisheye, Eigen::Isometry3d::Identity(), 3.0), std::nullopt);
  Eigen::Isometry3d sideways = Eigen::Isometry3d::Identity();
  sideways.rotate(Eigen::AngleAxisd(1.0, Vec3::UnitX()));
  EXPECT_EQ(sight_reach_m(wide_lens(), sideways, 3.0), std::nullopt);
}

}  // namespace
}  // namespace lodestar
