#include "app/simulate/disturbances.hpp"

#include <algorithm>
#include <cmath>
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
  const MarkerRegistry left = hung_markers(all, {.removed_markers = 0.5}, {}, 3);
  EXPECT_EQ(left.markers.size(), 20U);
  EXPECT_EQ(ids_of(left), ids_of(hung_markers(all, {.removed_markers = 0.5}, {}, 3)));
  EXPECT_NE(ids_of(left), ids_of(hung_markers(all, {.removed_markers = 0.5}, {}, 4)));
  EXPECT_EQ(ids_of(hung_markers(all, {}, {}, 3)), ids_of(all));
}

TEST(Disturbances, leave_the_markers_nearest_to_start_and_goals) {
  const std::vector<Vec2> places_m{{0.2, 1.0}, {38.8, -1.0}};
  EXPECT_EQ(ids_of(hung_markers(row_of_markers(40), {.removed_markers = 1.0}, places_m, 1)),
            (std::vector{100, 139}));
}

TEST(Disturbances, hang_markers_off_their_places_by_what_is_asked) {
  constexpr double sigma_m = 0.01;
  const MarkerRegistry all = row_of_markers(400);
  const MarkerRegistry hung =
      hung_markers(all, {.misplaced_m = sigma_m, .misturned_rad = radians(1.0)}, {}, 3);
  double squared_m2 = 0.0;
  double squared_rad2 = 0.0;
  for (std::size_t i = 0; i < all.markers.size(); ++i) {
    squared_m2 += (hung.markers[i].position_m - all.markers[i].position_m).squaredNorm();
    squared_rad2 += square(hung.markers[i].yaw_rad - all.markers[i].yaw_rad);
  }
  EXPECT_NEAR(std::sqrt(squared_m2 / 800.0), sigma_m, 0.1 * sigma_m) << "x and y of 400 markers, not z";
  EXPECT_NEAR(std::sqrt(squared_rad2 / 400.0), radians(1.0), radians(0.1));
}

TEST(Disturbances, hang_what_is_said_to_hang) {
  EXPECT_EQ(ids_of(hung_markers(row_of_markers(3), {.hung = row_of_markers(5)}, {}, 1)),
            ids_of(row_of_markers(5)));
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
