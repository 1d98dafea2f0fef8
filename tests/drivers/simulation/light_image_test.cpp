#include "drivers/simulation/light_image.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace lodestar {
namespace {

struct Moments {
  double light = 0.0;
  Vec2 center_px = Vec2::Zero();
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Zero();
};

Moments moments_of(const LightImage& image) {
  Moments of;
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (int v = 0; v < image.height_px(); ++v) {
    for (int u = 0; u < image.width_px(); ++u) {
      const double light = image.row(v)[u];
      const Vec2 at(u, v);
      of.light += light;
      of.center_px += light * at;
      second += light * at * at.transpose();
    }
  }
  of.center_px /= of.light;
  of.covariance_px2 = second / of.light - of.center_px * of.center_px.transpose();
  return of;
}

/// Three times as long as wide, turned by 30 degrees.
ProjectedDisc slanted_ellipse(const Vec2& center_px) {
  constexpr double long_px = 6.0;
  constexpr double short_px = 2.0;
  const double turned_rad = std::numbers::pi / 6.0;
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(turned_rad).toRotationMatrix();
  const Eigen::Matrix2d size = Eigen::Vector2d(long_px, short_px).asDiagonal();
  const Eigen::Matrix2d shape = turn * size * size * turn.transpose();
  return {.center_px = center_px,
          .unit_from_px = size.inverse() * turn.transpose(),
          .radius_px = std::sqrt(long_px * short_px),
          .half_size_px = Vec2(std::sqrt(shape(0, 0)), std::sqrt(shape(1, 1)))};
}

Moments painted(const Vec2& motion_px) {
  LightImage image(240, 200);
  image.paint(slanted_ellipse({121.3, 98.6}), motion_px, 200.0, 0.8, DiscProfile());
  return moments_of(image);
}

TEST(LightImage, smears_an_ellipse_evenly_along_a_long_motion_and_loses_none_of_its_light) {
  const Moments still = painted(Vec2::Zero());
  for (const Vec2& motion_px : {Vec2(150.0, 0.0), Vec2(0.0, -120.0), Vec2(110.0, 60.0), Vec2(-60.0, 110.0)}) {
    const Moments smeared = painted(motion_px);
    EXPECT_NEAR(smeared.light, still.light, 0.005 * still.light);
    EXPECT_LT((smeared.center_px - still.center_px).norm(), 0.05);
    const Eigen::Matrix2d evenly = motion_px * motion_px.transpose() / 12.0;
    EXPECT_LT((smeared.covariance_px2 - still.covariance_px2 - evenly).norm(), 0.005 * evenly.norm());
  }
}

TEST(LightImage, has_nothing_left_of_a_dot_that_is_smeared_over_kilometres) {
  LightImage image(240, 200);
  image.paint(slanted_ellipse({121.3, 98.6}), {3e6, 1e6}, 200.0, 0.8, DiscProfile());
  EXPECT_LT(image.row(98)[121], LightImage::units_per_gray / 32);
}

}  // namespace
}  // namespace lodestar
