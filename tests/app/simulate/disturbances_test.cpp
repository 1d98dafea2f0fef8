#include "app/simulate/disturbances.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace lodestar {
namespace {

MarkerRegistry row_of_markers(int count) {
  MarkerRegistry registry;
  for (int i = 0; i < count; ++i) {
    RegisteredMarker marker;
    marker.id = 100 + i;
    marker.position_m = Vec3(i, 0.0, 2.6);
    registry.markers.push_back(marker);
  }
  return registry;
}

std::vector<int> ids_of(const MarkerRegistry& registry) {
  std::vector<int> ids;
  for (const RegisteredMarker& marker : registry.markers) ids.push_back(marker.id);
  return ids;
}

TEST(Disturbances, take_the_share_of_markers_away_that_the_seed_draws) {
  const MarkerRegistry all = row_of_markers(40);
  const MarkerRegistry left = with_markers_removed(all, 0.5, {}, 3);
  EXPECT_EQ(left.markers.size(), 20U);
  EXPECT_EQ(ids_of(left), ids_of(with_markers_removed(all, 0.5, {}, 3)));
  EXPECT_NE(ids_of(left), ids_of(with_markers_removed(all, 0.5, {}, 4)));
  EXPECT_EQ(ids_of(with_markers_removed(all, 0.0, {}, 3)), ids_of(all));
}

TEST(Disturbances, leave_the_markers_nearest_to_start_and_goals) {
  const std::vector<Vec2> places_m{{0.2, 1.0}, {38.8, -1.0}};
  EXPECT_EQ(ids_of(with_markers_removed(row_of_markers(40), 1.0, places_m, 1)), (std::vector{100, 139}));
}

TEST(Disturbances, make_the_ceiling_plain_only_when_asked) {
  EXPECT_GT(with_disturbances({}, {}).camera.texture_gray, 0.0);
  const SimulatedCameraOptions plain = with_disturbances({}, {.plain_ceiling = true}).camera;
  EXPECT_EQ(plain.texture_gray, 0.0);
  EXPECT_FALSE(plain.tubes || plain.lamps || plain.glints);
}

TEST(Disturbances, make_wheels_unequal_and_lose_frames_only_when_asked) {
  const SimulationOptions usual;
  const SimulationOptions same = with_disturbances(usual, {});
  EXPECT_EQ(same.base.left_wheel_scale, usual.base.left_wheel_scale);
  EXPECT_EQ(same.camera.lost_frame_probability, usual.camera.lost_frame_probability);
  const SimulationOptions hard = with_disturbances(usual, {.lost_frames = 0.3, .unequal_wheels = 0.03});
  EXPECT_NEAR(hard.base.left_wheel_scale - hard.base.right_wheel_scale, 0.03, 1e-12);
  EXPECT_EQ(hard.camera.lost_frame_probability, 0.3);
}

}  // namespace
}  // namespace lodestar
