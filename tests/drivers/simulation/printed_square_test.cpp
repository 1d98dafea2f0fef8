#include "drivers/simulation/printed_square.hpp"

#include <gtest/gtest.h>

#include "drivers/simulation/image_former.hpp"
#include "maps/paper_camera.hpp"

#include "tests/drivers/ceiling_pictures.hpp"

namespace lodestar {
namespace {

using testing::camera_at;
using testing::plain_light;

constexpr double ceiling_m = 2.6;

/// White except for a black quarter at the top left of the printed face; it hangs face down, and a camera
/// that looks up with yaw 0 sees it upright.
PrintedSquare quartered(double x_m, double y_m) {
  PrintedSquare square;
  square.map_from_square.linear() = Vec3(1.0, -1.0, -1.0).asDiagonal();
  square.map_from_square.translation() << x_m, y_m, ceiling_m;
  square.side_m = 0.2;
  square.modules = 2;
  square.gray = {30.0, 200.0, 200.0, 200.0};
  return square;
}

ImageFormer former_with(const PrintedSquare& square, const CameraModel& camera = paper_camera()) {
  ImageFormer former({}, camera, plain_light(), 1);
  former.add(square);
  return former;
}

cv::Mat seen_by(ImageFormer& former, const Eigen::Isometry3d& pose) {
  return former.expose(pose, pose, 0);
}

int gray_at(const cv::Mat& image, const Vec2& pixel) {
  return image.at<std::uint8_t>(static_cast<int>(std::lround(pixel.y())),
                                static_cast<int>(std::lround(pixel.x())));
}

TEST(PrintedSquare, reads_as_printed_to_a_camera_below) {
  ImageFormer former = former_with(quartered(0.0, 0.0));
  const cv::Mat image = seen_by(former, camera_at(0.0, 0.0, 0.0, {}));
  const Vec2 middle(paper_camera().cx_px, paper_camera().cy_px);
  EXPECT_EQ(gray_at(image, middle + Vec2(-14, -14)), 30);
  EXPECT_EQ(gray_at(image, middle + Vec2(14, -14)), 200);
  EXPECT_EQ(gray_at(image, middle + Vec2(-14, 14)), 200);
  EXPECT_EQ(gray_at(image, middle + Vec2(14, 14)), 200);
  EXPECT_EQ(gray_at(image, middle + Vec2(60, 0)), 35) << "the ceiling beside it";
}

TEST(PrintedSquare, has_its_light_where_the_camera_model_puts_it) {
  // Area, brightness and centroid of a plain patch, at arbitrary subpixel positions.
  PrintedSquare patch = quartered(0.0, 0.0);
  patch.modules = 1;
  patch.gray = {200.0};
  for (const CameraModel& camera : {paper_camera(), testing::distorted(testing::wide_camera())}) {
    for (const double yaw : {0.0, 0.3, 1.1}) {
      ImageFormer former = former_with(patch, camera);
      const Eigen::Isometry3d pose = camera_at(0.0731, -0.0419, 1.1, {0.0, 0.0, yaw});
      const cv::Mat image = seen_by(former, pose);
      const Vec2 expected = *camera.project(pose.inverse() * patch.map_from_square.translation());
      const testing::Spot spot = testing::measure_spot(image, expected, 100, 35.0);
      // Lens distortion moves the centroid of an area a little.
      const double tolerance_px = camera.distortion == Distortion::none ? 0.01 : 0.06;
      EXPECT_NEAR((spot.center_px - expected).norm(), 0.0, tolerance_px) << yaw;
      if (camera.distortion != Distortion::none) continue;
      const double side_px2 = camera.fx_px * camera.fy_px * std::pow(patch.side_m / 1.5, 2);
      EXPECT_NEAR(spot.light / (165.0 * side_px2), 1.0, 0.005) << yaw;
    }
  }
}

TEST(PrintedSquare, is_blurred_as_the_dots_are) {
  PrintedSquare patch = quartered(0.0, 0.0);
  patch.modules = 1;
  patch.gray = {235.0};
  SimulatedCameraOptions options = plain_light();
  options.blur_sigma_px = 1.2;
  ImageFormer former({}, paper_camera(), options, 1);
  former.add(patch);
  const cv::Mat image = seen_by(former, camera_at(0.0, 0.0, 0.0, {}));
  const double edge_px = paper_camera().cx_px + 0.1 * paper_camera().fx_px / ceiling_m;
  const double sigma_px = std::sqrt(1.2 * 1.2 + 1.0 / 12.0);
  for (int u = 345; u < 355; ++u) {
    const double share = 0.5 * std::erfc((u - edge_px) / (std::sqrt(2.0) * sigma_px));
    EXPECT_NEAR(image.at<std::uint8_t>(240, u), 35.0 + 200.0 * share, 1.5) << u;
  }
}

TEST(PrintedSquare, may_be_cut_by_the_border_and_is_not_seen_from_behind) {
  ImageFormer former = former_with(quartered(1.1, 0.0));
  EXPECT_EQ(gray_at(seen_by(former, camera_at(0.0, 0.0, 0.0, {})), Vec2(632, 255)), 200)
      << "visible, although its centre is just beyond x = 639 px";
  ImageFormer above = former_with(quartered(0.0, 0.0));
  const cv::Mat image = seen_by(above, camera_at(0.0, 0.0, 5.0, {std::numbers::pi, 0.0, 0.0}));
  EXPECT_EQ(gray_at(image, {320, 240}), 35);
}

TEST(PrintedSquare, covers_a_marker_or_hangs_behind_it) {
  const MarkerRegistry registry = testing::one_marker(0, {0.0, 0.0, ceiling_m});
  PrintedSquare square = quartered(0.0, 0.0);
  square.modules = 1;
  square.gray = {60.0};
  ImageFormer former(registry, paper_camera(), plain_light(), 1);
  const Eigen::Isometry3d pose = camera_at(0.0, 0.0, 0.0, {});
  former.add(square);
  EXPECT_GT(gray_at(seen_by(former, pose), {320, 240}), 220);
  EXPECT_EQ(former.dots_in_view(pose).size(), 3U);
  former.cover({square});
  EXPECT_EQ(gray_at(seen_by(former, pose), {320, 240}), 60);
  former.cover({});
  former.take_markers_down();
  EXPECT_EQ(gray_at(seen_by(former, pose), {320, 240}), 60);
  EXPECT_TRUE(former.dots_in_view(pose).empty());
}

}  // namespace
}  // namespace lodestar
