#include "app/bench/cramer_rao.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "drivers/simulation/image_former.hpp"
#include "maps/marker.hpp"
#include "maps/paper_camera.hpp"

namespace lodestar {
namespace {

constexpr double ceiling_m = 2.6;

/// A marker of nine dots, aligned with the map's axes.
MarkerRegistry nine_dots() {
  MarkerRegistry registry;
  registry.markers = {{0x6c6, {0.0, 0.0, ceiling_m}, 0.0, 0}};
  return registry;
}

std::vector<InformativeDot> dots_with_noise(const MarkerRegistry& registry, double sigma_px) {
  std::vector<InformativeDot> dots;
  for (const RegisteredMarker& marker : registry.markers) {
    for (const GridCell cell : dots_of(marker.id)) {
      const Vec2 place = cell_in_marker(cell);
      dots.push_back({map_from_marker(registry, marker) * Vec3(place.x(), place.y(), 0.0),
                      Eigen::Matrix2d::Identity() / (sigma_px * sigma_px)});
    }
  }
  return dots;
}

Eigen::Isometry3d upright_at(double x_m, double y_m) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << x_m, y_m, 0.0;
  return pose;
}

TEST(CramerRao, of_nine_dots_seen_upright_half_a_metre_off_is_half_a_millimetre) {
  const auto dots = dots_with_noise(nine_dots(), 0.05);
  ASSERT_EQ(dots.size(), 9U);
  const auto bound = cramer_rao_bound(upright_at(-0.44, -0.06), dots, paper_camera(), Tilt::known);
  ASSERT_TRUE(bound);
  EXPECT_NEAR(std::sqrt(bound->covariance(0, 0)), 0.00046, 0.00004) << "limited by the height";
  EXPECT_NEAR(std::sqrt(bound->covariance(1, 1)), 0.00046, 0.00004) << "limited by the yaw";
  EXPECT_NEAR(bound->height_m(), 0.0023, 0.00015);
  EXPECT_NEAR(degrees(bound->yaw_rad()), 0.05, 0.004);
}

TEST(CramerRao, with_free_tilt_is_centimetres) {
  const auto dots = dots_with_noise(nine_dots(), 0.05);
  const auto bound = cramer_rao_bound(upright_at(-0.44, -0.06), dots, paper_camera(), Tilt::free);
  ASSERT_TRUE(bound);
  EXPECT_GT(bound->lateral_m(), 0.02) << "tilt and position nearly coincide for so small a target";
  EXPECT_LT(bound->lateral_m(), 0.08);
}

/// For a centred, upright view the sums are short: sigma z / (f sqrt n) for x and y; for yaw and for the
/// logarithm of the height, sigma over the root of the sum of squared distances from the centre.
TEST(CramerRao, of_a_centred_marker_is_what_pencil_and_paper_give) {
  MarkerRegistry registry = nine_dots();
  CameraModel camera = paper_camera();
  camera.fy_px = camera.fx_px;
  const auto dots = dots_with_noise(registry, 0.016);
  Vec3 middle = Vec3::Zero();
  for (const InformativeDot& dot : dots) middle += dot.point_in_map / 9.0;
  double spread_px2 = 0.0;
  for (const InformativeDot& dot : dots)
    spread_px2 += (dot.point_in_map - middle).squaredNorm() * std::pow(camera.fx_px / ceiling_m, 2);
  const auto bound = cramer_rao_bound(upright_at(middle.x(), middle.y()), dots, camera, Tilt::known);
  ASSERT_TRUE(bound);
  EXPECT_NEAR(bound->lateral_m(), std::sqrt(2.0) * 0.016 * ceiling_m / (camera.fx_px * 3.0), 1e-8);
  EXPECT_NEAR(bound->yaw_rad(), 0.016 / std::sqrt(spread_px2), 1e-8);
  EXPECT_NEAR(bound->height_m(), ceiling_m * 0.016 / std::sqrt(spread_px2), 1e-7);
}

TEST(CramerRao, is_nothing_when_the_dots_leave_the_pose_open) {
  auto dots = dots_with_noise(nine_dots(), 0.05);
  dots.resize(1);
  EXPECT_FALSE(cramer_rao_bound(upright_at(0.0, 0.0), dots, paper_camera(), Tilt::known));
  dots.resize(0);
  EXPECT_FALSE(cramer_rao_bound(upright_at(0.0, 0.0), dots, paper_camera(), Tilt::free));
  Eigen::Isometry3d above = upright_at(0.0, 0.0);
  above.translation().z() = 3.0;
  EXPECT_FALSE(cramer_rao_bound(above, dots_with_noise(nine_dots(), 0.05), paper_camera(), Tilt::known));
}

/// Light of contrast C in a disc of radius r, blurred by s: its squared slopes sum up to C^2 pi r / (2
/// sqrt(pi) s) along either axis, the squared profile of a blurred edge integrated along the rim.
TEST(CramerRao, of_rendered_dots_is_what_their_rims_tell) {
  SimulatedCameraOptions options;
  options.read_noise_gray = 4.0;
  options.shot_noise_gray_at_255 = 0.0;
  options.dot_gray_sigma = 0.0;
  const ImageFormer former(nine_dots(), paper_camera(), options, 1);
  const std::vector<SeenDot> seen = former.dots_in_view(upright_at(0.06, -0.06));
  ASSERT_EQ(seen.size(), 9U);
  const double contrast_gray = options.dot_gray - options.background_gray;
  const double radius_px = 0.01 * 754.5 / ceiling_m;
  const double blur_px = std::sqrt(0.25 + 1.0 / 12.0);
  const double slopes2 =
      std::pow(contrast_gray, 2) * std::sqrt(std::numbers::pi) * radius_px / (2.0 * blur_px);
  const double sigma_px = std::sqrt((16.0 + 1.0 / 12.0) / slopes2);
  EXPECT_NEAR(sigma_px, 0.009, 0.0005) << "a plain centroid of the same dot has 0.016";
  for (const SeenDot& dot : seen) {
    const Eigen::Matrix2d covariance = dot.information_per_px2.inverse();
    EXPECT_NEAR(std::sqrt(covariance(0, 0)), sigma_px, 0.03 * sigma_px);
    EXPECT_NEAR(std::sqrt(covariance(1, 1)), sigma_px, 0.03 * sigma_px);
    EXPECT_NEAR(covariance(0, 1) / covariance(0, 0), 0.0, 0.02);
  }
}

}  // namespace
}  // namespace lodestar
