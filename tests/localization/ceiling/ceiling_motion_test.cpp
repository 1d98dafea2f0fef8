#include "localization/ceiling/ceiling_motion.hpp"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "maps/paper_camera.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

constexpr double ceiling_m = 2.6;
constexpr double lean_sigma_rad = 0.002;
constexpr double texel_m = 0.002;
constexpr int texels = 2600;  // along a side; the map's origin lies in the middle

/// Stains of a few centimetres, with a standard deviation of `gray`.
cv::Mat1f stained(double gray, std::uint64_t seed) {
  Random random(seed);
  cv::Mat1f coarse(texels / 4, texels / 4);
  for (float& value : coarse) value = static_cast<float>(random.normal());
  cv::GaussianBlur(coarse, coarse, {}, 2.5);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(coarse, mean, deviation);
  cv::Mat1f ceiling;
  cv::resize(coarse * (gray / deviation[0]), ceiling, {texels, texels}, 0.0, 0.0, cv::INTER_CUBIC);
  return ceiling;
}

struct Picture {
  CameraModel camera = paper_camera();
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();
  cv::Mat1f ceiling;
  double noise_gray = 1.5;
  Random random{7};

  explicit Picture(double gray = 4.0) : ceiling(stained(gray, 3)) {
    base_from_camera.translation() = Vec3(-0.10, 0.02, 1.1);
    base_from_camera.linear() = rotation_from({radians(0.3), radians(-0.2), radians(3.0)});
  }

  /// Rendered along each pixel's ray, so that any lens model works.
  [[nodiscard]] Frame at(const Pose2& map_from_base, double time_s) {
    const Eigen::Isometry3d map_from_camera = lifted(map_from_base) * base_from_camera;
    cv::Mat1f x(camera.height_px, camera.width_px);
    cv::Mat1f y(camera.height_px, camera.width_px);
    for (int v = 0; v < camera.height_px; ++v) {
      for (int u = 0; u < camera.width_px; ++u) {
        const Vec3 ray = map_from_camera.linear() * camera.normalized(Vec2(u, v))->homogeneous();
        const Vec3 from = map_from_camera.translation();
        const Vec3 point = from + (ceiling_m - from.z()) / ray.z() * ray;
        x(v, u) = static_cast<float>(point.x() / texel_m + texels / 2.0);
        y(v, u) = static_cast<float>(point.y() / texel_m + texels / 2.0);
      }
    }
    cv::Mat1f light;
    cv::remap(ceiling, light, x, y, cv::INTER_LINEAR, cv::BORDER_REFLECT);
    for (float& value : light) value += static_cast<float>(40.0 + noise_gray * random.normal());
    Frame frame{Stamp(from_seconds(time_s)), {}};
    light.convertTo(frame.gray, CV_8U);
    return frame;
  }

  [[nodiscard]] CeilingMotion motion() const { return {camera, base_from_camera, ceiling_m, lean_sigma_rad}; }
};

const Pose2 before{{0.2, -0.1}, radians(25.0)};
const Pose2 way{{0.21, -0.04}, radians(8.0)};
const Pose2 guess = way * Pose2{{0.012, -0.008}, radians(-0.8)};

/// The increment between two frames of a robot that moved by `way`, where `guess` is the prediction.
std::optional<VisualOdometryIncrement> motion_between(const Frame& then, const Frame& now,
                                                      const Picture& picture) {
  CeilingMotion ceiling = picture.motion();
  ceiling.set_frame(then);
  if (!ceiling.set_keyframe()) return std::nullopt;
  ceiling.set_frame(now);
  return ceiling.motion(guess);
}

Vec3 error_of(const VisualOdometryIncrement& motion) {
  Vec3 error;
  error << motion.then_from_now.position_m - way.position_m,
      wrap_angle(motion.then_from_now.yaw_rad - way.yaw_rad);
  return error;
}

void expect_right(const std::optional<VisualOdometryIncrement>& motion, double within_m, double within_rad) {
  ASSERT_TRUE(motion);
  const Vec3 error = error_of(*motion);
  EXPECT_LT(error.head<2>().norm(), within_m);
  EXPECT_LT(std::abs(error.z()), within_rad);
}

TEST(CeilingMotion, lies_where_both_pictures_agree) {
  Picture picture;
  const std::optional<VisualOdometryIncrement> motion =
      motion_between(picture.at(before, 1.0), picture.at(before * way, 1.5), picture);
  expect_right(motion, 0.001, radians(0.1));
  EXPECT_EQ(motion->from, Stamp(from_seconds(1.0)));
  EXPECT_EQ(motion->to, Stamp(from_seconds(1.5)));
  EXPECT_NEAR(motion->sway_m, lean_sigma_rad * ceiling_m, 1e-12);
}

TEST(CeilingMotion, is_the_same_through_a_lens_that_bends) {
  Picture picture;
  picture.camera.distortion = Distortion::plumb_bob;
  picture.camera.coefficients = {-0.2, 0.05, 0.0008, -0.0005, 0.0};
  expect_right(motion_between(picture.at(before, 1.0), picture.at(before * way, 1.5), picture), 0.001,
               radians(0.1));
}

TEST(CeilingMotion, outvotes_what_the_camera_carries_along) {
  Picture picture;
  Frame then = picture.at(before, 1.0);
  Frame now = picture.at(before * way, 1.5);
  for (const Frame& frame : {then, now}) {
    for (int i = 0; i < 6; ++i)
      cv::circle(frame.gray, {60 + 90 * i, 60 + 20 * i}, 9, cv::Scalar(90), cv::FILLED, cv::LINE_AA);
    for (int v = 0; v < frame.gray.rows; ++v)
      frame.gray.row(v) *= 1.0 - 0.3 * std::pow(v / 240.0 - 1.0, 2.0);  // vignetting
  }
  expect_right(motion_between(then, now, picture), 0.002, radians(0.2));
}

TEST(CeilingMotion, is_as_sure_as_it_may_be) {
  Picture picture;
  double sum = 0.0;
  constexpr int pairs = 30;
  for (int i = 0; i < pairs; ++i) {
    const Pose2 from = before * Pose2{{0.03 * i, 0.02 * i}, radians(11.0 * i)};
    const std::optional<VisualOdometryIncrement> motion =
        motion_between(picture.at(from, 1.0), picture.at(from * way, 1.5), picture);
    ASSERT_TRUE(motion) << i;
    const Vec3 error = error_of(*motion);
    sum += error.dot(motion->covariance.ldlt().solve(error));
  }
  EXPECT_LT(sum / pairs, 3.0) << "not overconfident: the mean is 3 at most";
  EXPECT_GT(sum / pairs, 0.3) << "nor far too cautious";
}

TEST(CeilingMotion, is_unknown_under_a_plain_ceiling) {
  Picture picture(0.0);
  CeilingMotion ceiling = picture.motion();
  ceiling.set_frame(picture.at(before, 1.0));
  EXPECT_FALSE(ceiling.set_keyframe());
  EXPECT_FALSE(ceiling.keyframe_stamp());
  EXPECT_FALSE(ceiling.motion(guess));
}

// Vignetting, hot pixels or dirt alone give no motion, however alike two frames of them are.
TEST(CeilingMotion, is_unknown_where_only_the_camera_shows_something) {
  Picture picture(0.0);
  Frame then = picture.at(before, 1.0);
  Frame now = picture.at(before * way, 1.5);
  for (cv::Mat1b shared : {cv::Mat1b(then.gray), cv::Mat1b(now.gray)}) {
    for (int v = 0; v < shared.rows; ++v) {
      for (int u = 0; u < shared.cols; ++u) {
        uchar& gray = shared(v, u);
        const double aside = (Vec2(u, v) - Vec2(320.0, 240.0)).squaredNorm() / 320.0 / 320.0;
        gray = cv::saturate_cast<uchar>((1.0 - 0.4 * aside) * gray);
      }
    }
  }
  EXPECT_FALSE(motion_between(then, now, picture));
  Random random(9);
  for (int i = 0; i < 200; ++i) {
    const cv::Point dirt(static_cast<int>(random.below(640)), static_cast<int>(random.below(480)));
    for (const Frame& frame : {then, now}) cv::circle(frame.gray, dirt, 4, cv::Scalar(70), cv::FILLED);
  }
  EXPECT_FALSE(motion_between(then, now, picture)) << "too far from the prediction";
  CeilingMotion ceiling = picture.motion();
  ceiling.set_frame(then);
  ASSERT_TRUE(ceiling.set_keyframe());
  ceiling.set_frame(now);
  EXPECT_FALSE(ceiling.motion({{0.005, 0.0}, 0.0})) << "dirt and ceiling cannot be told apart";
}

TEST(CeilingMotion, is_unknown_where_pictures_show_different_things) {
  Picture picture;
  const Frame then = picture.at(before, 1.0);
  const Frame now = picture.at(before * way, 1.5);
  EXPECT_TRUE(motion_between(then, now, picture));
  EXPECT_FALSE(motion_between(then, picture.at(before * Pose2{{1.1, 0.3}, 0.0}, 1.5), picture));
  Frame covered = now;
  covered.gray = cv::Mat(now.gray.size(), CV_8UC1, cv::Scalar(60));
  EXPECT_FALSE(motion_between(then, covered, picture));
}

TEST(CeilingMotion, says_when_the_kept_picture_leaves_the_view) {
  Picture picture;
  CeilingMotion ceiling = picture.motion();
  ceiling.set_frame(picture.at(before, 1.0));
  ASSERT_TRUE(ceiling.set_keyframe());
  EXPECT_FALSE(ceiling.leaves_view({}));
  EXPECT_FALSE(ceiling.leaves_view({{0.1, 0.0}, 0.1}));
  EXPECT_TRUE(ceiling.leaves_view({{0.6, 0.0}, 0.0}));
  EXPECT_FALSE(ceiling.motion({{0.9, 0.0}, 0.0})) << "too little overlap";
}

TEST(CeilingMotion, needs_one_ceiling) {
  MarkerRegistry registry;
  EXPECT_FALSE(ceiling_height_m(registry)) << "no marker gives the height";
  registry.markers = {{1, {0.0, 0.0, 2.60}, 0.0, 0}, {2, {1.0, 0.0, 2.62}, 0.0, 0}};
  EXPECT_NEAR(ceiling_height_m(registry).value(), 2.61, 1e-12);
  registry.markers.push_back({3, {2.0, 0.0, 3.0}, 0.0, 0});
  EXPECT_FALSE(ceiling_height_m(registry));
}

}  // namespace
}  // namespace lodestar
