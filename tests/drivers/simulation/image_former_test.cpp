#include "drivers/simulation/image_former.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "maps/paper_camera.hpp"

#include "tests/drivers/ceiling_pictures.hpp"

namespace lodestar {
namespace {

using testing::camera_at;
using testing::distorted;
using testing::many_markers;
using testing::measure_spot;
using testing::one_marker;
using testing::plain_light;
using testing::Spot;
using testing::wide_camera;

constexpr int margin_px = 12;

bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::countNonZero(a != b) == 0;
}

/// Centroid of the image of a disc, by Green's theorem along its finely sampled outline.
std::optional<Vec2> true_centroid(const Vec3& center, double radius, const Eigen::Isometry3d& map_from_camera,
                                  const CameraModel& camera) {
  constexpr int count = 720;
  const Eigen::Isometry3d camera_from_map = map_from_camera.inverse();
  const auto rim = [&](int i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    return camera.project(camera_from_map * (center + radius * Vec3(std::cos(angle), std::sin(angle), 0.0)));
  };
  const std::optional<Vec2> middle = camera.project(camera_from_map * center);
  if (!middle || !camera.contains(*middle, margin_px)) return std::nullopt;
  double area = 0.0;
  Vec2 moment = Vec2::Zero();
  for (int i = 0; i < count; ++i) {
    const Vec2 a = *rim(i) - *middle;
    const Vec2 b = *rim(i + 1) - *middle;
    const double twice_triangle = cross(a, b);
    area += twice_triangle / 2.0;
    moment += twice_triangle * (a + b) / 6.0;
  }
  return Vec2(*middle + moment / area);
}

struct CameraAndHeight {
  CameraModel camera;
  double ceiling_m;
};

class EitherCamera : public ::testing::TestWithParam<CameraAndHeight> {};

TEST_P(EitherCamera, dots_lie_where_the_perspective_puts_their_centroids) {
  const auto& [camera, height] = GetParam();
  const SimulatedCameraOptions options = plain_light();
  const MarkerRegistry registry = one_marker(0, {0.0, 0.0, height}, 0.4);  // O, X and Y only, far apart
  ImageFormer former(registry, camera, options, 1);
  Random random(2);
  int dots_seen = 0;
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    const Eigen::Isometry3d map_from_camera =
        camera_at(random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), 0.0,
                  {random.uniform(-0.15, 0.15), random.uniform(-0.15, 0.15), random.uniform(-3.0, 3.0)});
    const cv::Mat gray = former.expose(map_from_camera, map_from_camera, trial);
    for (const GridCell cell : dots_of(0)) {
      const Vec2 in_marker = cell_in_marker(cell);
      const Vec3 center =
          map_from_marker(registry, registry.markers[0]) * Vec3(in_marker.x(), in_marker.y(), 0.0);
      const auto expected = true_centroid(center, marker_dot_radius_m, map_from_camera, camera);
      if (!expected) continue;
      ++dots_seen;
      const Spot spot = measure_spot(gray, *expected, 9, options.background_gray);
      EXPECT_LT((spot.center_px - *expected).norm(), 0.02) << "trial " << trial;
    }
  }
  EXPECT_GT(dots_seen, 300);
}

TEST_P(EitherCamera, a_dot_sends_as_much_light_as_its_image_is_large) {
  const auto& [camera, height] = GetParam();
  const SimulatedCameraOptions options = plain_light();
  ImageFormer former(one_marker(0, {0.0, 0.0, height}), camera, options, 1);
  const Eigen::Isometry3d upright = camera_at(0.0, 0.0, 0.0, {});
  const Spot spot = measure_spot(former.expose(upright, upright, 0), {camera.cx_px, camera.cy_px}, 9,
                                 options.background_gray);
  const double area_px2 =
      std::numbers::pi * std::pow(marker_dot_radius_m / height, 2) * camera.fx_px * camera.fy_px;
  EXPECT_NEAR(spot.light, area_px2 * (options.dot_gray - options.background_gray), 0.01 * spot.light);
}

/// f of Eq. (2), and one pixel's part in Eq. (3).
double pixel_confidence(double gray) {
  const double f = 2634.0 * std::exp(-std::pow(gray - 245.4, 2) / 196.84) +
                   525.0 * std::exp(-std::pow(gray - 208.6, 2) / 791.30);
  return (f - 478.2) / (2730.3 - 478.2);
}

std::vector<cv::Point> pixels_of(const cv::Mat& mask) {
  std::vector<cv::Point> pixels;
  cv::findNonZero(mask, pixels);
  return pixels;
}

/// Sum over the pixels in Eq. (3); P(S) is their mean.
struct Confidence {
  double sum = 0.0;
  int pixels = 0;
  [[nodiscard]] double mean() const { return sum / pixels; }
  [[nodiscard]] bool is_in_tables() const { return mean() >= 0.84 && mean() <= 0.95; }
};

/// Over the eroded dots of one marker; nothing when one of its dots is outside the frame.
std::optional<Confidence> confidence_of(const MarkerRegistry& registry, const RegisteredMarker& marker,
                                        const Eigen::Isometry3d& map_from_camera, const CameraModel& camera,
                                        const cv::Mat& gray, const cv::Mat& eroded) {
  Confidence confidence;
  for (const GridCell cell : dots_of(marker.id)) {
    const Vec2 in_marker = cell_in_marker(cell);
    const Vec3 in_map = map_from_marker(registry, marker) * Vec3(in_marker.x(), in_marker.y(), 0.0);
    const std::optional<Vec2> pixel = camera.project(map_from_camera.inverse() * in_map);
    if (!pixel || !camera.contains(*pixel, margin_px)) return std::nullopt;
    const cv::Rect around(cvRound(pixel->x()) - 3, cvRound(pixel->y()) - 3, 7, 7);
    for (const cv::Point& kept : pixels_of(eroded(around))) {
      confidence.sum += pixel_confidence(gray(around).at<std::uint8_t>(kept));
      ++confidence.pixels;
    }
  }
  return confidence;
}

TEST_P(EitherCamera, ordinary_light_gives_the_confidence_of_the_papers_tables) {
  const auto& [camera, height] = GetParam();
  const MarkerRegistry registry = many_markers(height, 0.5, 3);
  ImageFormer former(registry, camera, {}, 4);
  const cv::Mat cross = cv::getStructuringElement(cv::MORPH_CROSS, {3, 3});
  // Far from the wide camera, a marker has only a handful of pixels, too few for a mean.
  constexpr int enough_pixels = 30;
  constexpr int frames = 60;
  Random random(5);
  Confidence of_all;
  int markers = 0;
  int markers_in_tables = 0;
  int frames_in_tables = 0;
  for (std::uint64_t frame = 0; frame < frames; ++frame) {
    const Eigen::Isometry3d pose = camera_at(random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7), 0.0,
                                             {0.0, 0.0, random.uniform(-3.0, 3.0)});
    const cv::Mat gray = former.expose(pose, pose, frame);
    cv::Mat eroded;
    cv::erode(gray >= 200, eroded, cross);
    Confidence of_frame;
    for (const RegisteredMarker& marker : registry.markers) {
      const auto of_marker = confidence_of(registry, marker, pose, camera, gray, eroded);
      if (!of_marker) continue;
      of_frame.sum += of_marker->sum;
      of_frame.pixels += of_marker->pixels;
      if (of_marker->pixels < enough_pixels) continue;
      ++markers;
      if (of_marker->is_in_tables()) ++markers_in_tables;
    }
    of_all.sum += of_frame.sum;
    of_all.pixels += of_frame.pixels;
    if (of_frame.is_in_tables()) ++frames_in_tables;
  }
  EXPECT_NEAR(of_all.mean(), 0.895, 0.015);
  EXPECT_GE(frames_in_tables, 0.97 * frames);
  EXPECT_GE(markers_in_tables, 0.97 * markers);
}

INSTANTIATE_TEST_SUITE_P(Cameras, EitherCamera,
                         ::testing::Values(CameraAndHeight{paper_camera(), 2.6},
                                           CameraAndHeight{wide_camera(), 1.5},
                                           CameraAndHeight{distorted(paper_camera()), 2.6},
                                           CameraAndHeight{distorted(wide_camera()), 1.5}));

TEST(ImageFormer, shows_x_right_of_o_and_y_above_o) {
  // GIVEN a marker of yaw 0 and a camera of yaw 0 below it, looking straight up
  const CameraModel camera = paper_camera();
  const SimulatedCameraOptions options = plain_light();
  ImageFormer former(one_marker(0, {0.0, 0.0, 2.6}), camera, options, 1);
  const Eigen::Isometry3d upright = camera_at(0.0, 0.0, 0.0, {});
  const cv::Mat gray = former.expose(upright, upright, 0);
  // THEN O is in the middle, X to the right of it and Y above it, three pitches away
  const double side_px = 3 * marker_pitch_m * camera.fx_px / 2.6;
  const Vec2 o(camera.cx_px, camera.cy_px);
  for (const Vec2& dot : {o, Vec2(o + Vec2(side_px, 0.0)), Vec2(o - Vec2(0.0, side_px))}) {
    EXPECT_GT(gray.at<std::uint8_t>(cv::Point(cvRound(dot.x()), cvRound(dot.y()))), 230);
  }
  EXPECT_EQ(gray.at<std::uint8_t>(cv::Point(cvRound(o.x() - side_px), cvRound(o.y()))),
            options.background_gray);
  EXPECT_EQ(gray.at<std::uint8_t>(cv::Point(cvRound(o.x()), cvRound(o.y() + side_px))),
            options.background_gray);
}

TEST(ImageFormer, same_seed_and_number_give_the_same_bytes_in_any_order) {
  const MarkerRegistry registry = many_markers(1.5, 0.8, 6);
  ImageFormer one(registry, wide_camera(), {}, 7);
  ImageFormer other(registry, wide_camera(), {}, 7);
  ImageFormer of_other_seed(registry, wide_camera(), {}, 8);
  const Eigen::Isometry3d here = camera_at(0.1, 0.2, 0.0, {0.01, 0.0, 0.3});
  const Eigen::Isometry3d there = camera_at(0.5, 0.2, 0.0, {0.0, 0.02, 1.3});
  const cv::Mat first = one.expose(here, here, 1);
  one.expose(there, there, 2);
  other.expose(there, there, 9);
  EXPECT_TRUE(same_bytes(first, other.expose(here, here, 1)));
  EXPECT_TRUE(same_bytes(first, one.expose(here, here, 1)));
  EXPECT_FALSE(same_bytes(first, one.expose(here, here, 3)));
  EXPECT_FALSE(same_bytes(first, of_other_seed.expose(here, here, 1)));
}

TEST(ImageFormer, motion_smears_a_dot_along_it_and_moves_it_half_way) {
  const CameraModel camera = paper_camera();
  const SimulatedCameraOptions options = plain_light();
  ImageFormer former(one_marker(0, {0.0, 0.0, 2.6}), camera, options, 1);
  const Eigen::Isometry3d opening = camera_at(0.0, 0.0, 0.0, {});
  const Eigen::Isometry3d closing = camera_at(0.02, 0.0, 0.0, {});
  const Vec2 o(camera.cx_px, camera.cy_px);
  const Spot still = measure_spot(former.expose(opening, opening, 0), o, 9, options.background_gray);
  const Spot smeared = measure_spot(former.expose(opening, closing, 0), o, 9, options.background_gray);
  // The camera moves right, the image left, by 5.8 px; a uniform blur of length s has variance s^2 / 12.
  const double smear_px = 0.02 * camera.fx_px / 2.6;
  EXPECT_NEAR(smeared.center_px.x(), still.center_px.x() - smear_px / 2, 0.02);
  EXPECT_NEAR(smeared.center_px.y(), still.center_px.y(), 0.02);
  EXPECT_NEAR(smeared.covariance_px2(0, 0) - still.covariance_px2(0, 0), smear_px * smear_px / 12, 0.1);
  EXPECT_NEAR(smeared.covariance_px2(1, 1), still.covariance_px2(1, 1), 0.02);
  EXPECT_NEAR(smeared.light, still.light, 0.01 * still.light);
}

TEST(ImageFormer, a_dot_is_darker_in_a_corner_and_from_far) {
  // GIVEN three markers at the ceiling's height, two of them far from the axis, and one 0.8 m higher
  SimulatedCameraOptions options = plain_light();
  options.vignetting = 1.0;
  MarkerRegistry registry;
  registry.markers = {{0, {0.0, 0.0, 2.6}, 0.0, 0},
                      {0, {0.7, 0.5, 2.6}, 0.0, 0},
                      {0, {-0.7, 0.5, 2.6}, 0.0, 0},
                      {0, {0.4, 0.0, 3.4}, 0.0, 0}};
  const CameraModel camera = paper_camera();
  ImageFormer former(registry, camera, options, 1);
  const Eigen::Isometry3d upright = camera_at(0.0, 0.0, 0.0, {});
  const cv::Mat gray = former.expose(upright, upright, 0);
  const auto gray_of = [&](std::size_t i) {
    const Vec2 pixel = *camera.project(registry.markers[i].position_m);
    return static_cast<int>(gray.at<std::uint8_t>(cv::Point(cvRound(pixel.x()), cvRound(pixel.y()))));
  };
  // THEN both the corner and the distance darken a dot
  EXPECT_NEAR(gray_of(0), 246, 1);
  EXPECT_LT(gray_of(1), gray_of(0) - 1);
  EXPECT_LT(gray_of(3), gray_of(0) - 1);
}

TEST(ImageFormer, hard_light_is_an_option) {
  SimulatedCameraOptions options = plain_light();
  options.dot_gray = 160.0;
  options.background_gray = 90.0;
  ImageFormer former(one_marker(0, {0.0, 0.0, 2.6}), paper_camera(), options, 1);
  const Eigen::Isometry3d upright = camera_at(0.0, 0.0, 0.0, {});
  const cv::Mat gray = former.expose(upright, upright, 0);
  double lowest = 0.0;
  double highest = 0.0;
  cv::minMaxLoc(gray, &lowest, &highest);
  EXPECT_EQ(lowest, 90.0);
  EXPECT_EQ(highest, 160.0);
}

}  // namespace
}  // namespace lodestar
