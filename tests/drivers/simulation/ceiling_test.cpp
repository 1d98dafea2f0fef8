#include "drivers/simulation/ceiling.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "drivers/simulation/ceiling_texture.hpp"

#include "tests/drivers/ceiling_pictures.hpp"

namespace lodestar {
namespace {

using testing::many_markers;

double distance_to_tube_m(const CeilingTube& tube, const Vec3& point) {
  double nearest = 1e9;
  for (int i = 0; i <= 200; ++i) {
    const Vec3 on_tube = tube.from_m + i / 200.0 * (tube.to_m - tube.from_m);
    nearest = std::min(nearest, (on_tube - point).head<2>().norm());
  }
  return nearest;
}

TEST(Ceiling, hangs_every_dot_where_the_registry_says) {
  // Marker 0x020 has one coded dot, right of Y; its yaw of 90 degrees turns x to map y, and y to map x.
  MarkerRegistry registry = testing::one_marker(0x020, {1.0, 2.0, 2.6}, radians(90.0));
  registry.map_from_registry.position_m = {10.0, 0.0};
  const Ceiling ceiling = fit_ceiling(registry, testing::plain_light(), 1);
  ASSERT_EQ(ceiling.markers.size(), 1U);
  const std::vector<CeilingDisc>& dots = ceiling.markers[0].dots;
  const auto has_dot_at = [&](const Vec3& point) {
    return std::ranges::any_of(dots,
                               [&](const CeilingDisc& d) { return (d.center_m - point).norm() < 1e-9; });
  };
  EXPECT_EQ(dots.size(), 4U);
  EXPECT_TRUE(has_dot_at({11.0, 2.0, 2.6}));   // O
  EXPECT_TRUE(has_dot_at({11.0, 2.12, 2.6}));  // X
  EXPECT_TRUE(has_dot_at({11.12, 2.0, 2.6}));  // Y
  EXPECT_TRUE(has_dot_at({11.12, 2.04, 2.6}));
}

TEST(Ceiling, glues_dots_as_exactly_as_hands_do) {
  SimulatedCameraOptions options;
  options.dot_place_sigma_m = 0.0;
  const MarkerRegistry registry = many_markers(2.6, 1.3, 1);
  const std::vector<CeilingMarker> exact = hang_markers(registry, options, 7);
  options.dot_place_sigma_m = 0.0002;
  const std::vector<CeilingMarker> glued = hang_markers(registry, options, 7);
  double sum_m2 = 0.0;
  double dots = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    for (std::size_t k = 0; k < exact[i].dots.size(); ++k) {
      const Vec3 off_m = glued[i].dots[k].center_m - exact[i].dots[k].center_m;
      EXPECT_EQ(off_m.z(), 0.0) << "the dots stay in the marker's plane";
      EXPECT_EQ(glued[i].dots[k].gray, exact[i].dots[k].gray);
      sum_m2 += off_m.squaredNorm();
      ++dots;
    }
  }
  EXPECT_GT(dots, 300.0);
  EXPECT_NEAR(std::sqrt(sum_m2 / (2.0 * dots)), 0.0002, 0.00002);
}

TEST(Ceiling, tiles_lie_by_the_seed_and_lights_in_their_middles) {
  const MarkerRegistry registry = many_markers(2.6, 1.3, 1);
  const Ceiling ceiling = fit_ceiling(registry, {}, 5);
  EXPECT_EQ(ceiling.tile_corner_m, fit_ceiling(registry, {}, 5).tile_corner_m);
  EXPECT_NE(ceiling.tile_corner_m, fit_ceiling(registry, {}, 6).tile_corner_m);
  ASSERT_FALSE(ceiling.lamps.empty());
  for (const CeilingDisc& lamp : ceiling.lamps) {
    const Vec2 tiles = (lamp.center_m.head<2>() - ceiling.tile_corner_m) / ceiling_tile_m;
    for (const double place : tiles) EXPECT_NEAR(place - std::floor(place), 0.5, 1e-9);
  }
}

TEST(Ceiling, lights_keep_clear_of_markers_and_glints_off_their_film) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Ceiling ceiling = fit_ceiling(many_markers(2.6, 1.3, seed), {}, seed);
    EXPECT_GT(ceiling.tubes.size(), 5U);
    EXPECT_GT(ceiling.lamps.size(), 3U);
    EXPECT_GT(ceiling.glints.size(), 30U);
    for (const CeilingMarker& marker : ceiling.markers) {
      for (const CeilingTube& tube : ceiling.tubes)
        EXPECT_GT(distance_to_tube_m(tube, marker.middle_m), 0.29);
      for (const CeilingDisc& lamp : ceiling.lamps) {
        EXPECT_GT((lamp.center_m - marker.middle_m).norm(), 0.29 + lamp.radius_m);
      }
      for (const CeilingDisc& dot : marker.dots) {
        for (const CeilingDisc& glint : ceiling.glints) {
          EXPECT_GT((glint.center_m - dot.center_m).norm(), dot.radius_m + glint.radius_m + 0.03);
        }
      }
    }
  }
}

TEST(Ceiling, some_glints_pass_for_dots_by_size) {
  const Ceiling ceiling = fit_ceiling(many_markers(2.6, 1.3, 1), {}, 1);
  const auto like_dots = std::ranges::count_if(ceiling.glints, [](const CeilingDisc& glint) {
    return std::abs(glint.radius_m - marker_dot_radius_m) < 0.003 && glint.gray > 200.0;
  });
  EXPECT_GT(like_dots, 5);
  EXPECT_LT(like_dots, static_cast<std::ptrdiff_t>(ceiling.glints.size()) / 2);
}

TEST(Ceiling, is_decided_by_the_seed) {
  const MarkerRegistry registry = many_markers(2.6, 1.3, 1);
  const Ceiling one = fit_ceiling(registry, {}, 5);
  const Ceiling same = fit_ceiling(registry, {}, 5);
  const Ceiling other = fit_ceiling(registry, {}, 6);
  EXPECT_EQ(one.glints.front().center_m, same.glints.front().center_m);
  EXPECT_EQ(one.markers.front().dots.front().gray, same.markers.front().dots.front().gray);
  EXPECT_NE(one.glints.front().center_m, other.glints.front().center_m);
}

TEST(Ceiling, what_is_switched_off_does_not_hang_there) {
  SimulatedCameraOptions options;
  options.tubes = options.lamps = options.glints = false;
  const Ceiling ceiling = fit_ceiling(many_markers(2.6, 1.3, 1), options, 1);
  EXPECT_TRUE(ceiling.tubes.empty());
  EXPECT_TRUE(ceiling.lamps.empty());
  EXPECT_TRUE(ceiling.glints.empty());
}

TEST(Ceiling, without_markers_is_still_a_ceiling) {
  const Ceiling ceiling = fit_ceiling({}, {}, 1);
  EXPECT_GT(ceiling.height_m, 0.0);
  EXPECT_FALSE(ceiling.tubes.empty());
}

}  // namespace
}  // namespace lodestar
