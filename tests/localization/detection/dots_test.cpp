#include "localization/detection/dots.hpp"

#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <limits>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>

#include "localization/detection/light_noise.hpp"
#include "localization/pose/pose_fix.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

constexpr int side_px = 32;
constexpr double background_gray = 35.0;
constexpr double contrast_gray = 190.0;

/// A disc and its position.
struct OneDot {
  Vec2 center_px;
  double radius_px = 0.0;
  double blur_sigma_px = 0.0;  ///< the pixel's own area included
};

OneDot some_dot(Random& random, double least_radius_px, double most_radius_px) {
  return {{random.uniform(15.0, 17.0), random.uniform(15.0, 17.0)},
          random.uniform(least_radius_px, most_radius_px),
          random.uniform(0.55, 0.8)};
}

/// Share of the dot's light that falls on a pixel.
double share_at(const OneDot& dot, int u, int v) {
  const double outside_px = (Vec2(u, v) - dot.center_px).norm() - dot.radius_px;
  return 0.5 * std::erfc(outside_px / (std::sqrt(2.0) * dot.blur_sigma_px));
}

/// Renders the dot analytically, so that only rounding to whole gray values and noise shift its centroid.
cv::Mat picture_of(const OneDot& dot, double dark_noise_gray, double variance_per_gray, Random& random) {
  cv::Mat gray(side_px, side_px, CV_8UC1);
  for (int v = 0; v < side_px; ++v) {
    for (int u = 0; u < side_px; ++u) {
      const double light = contrast_gray * share_at(dot, u, v);
      const double noise_gray = std::sqrt(dark_noise_gray * dark_noise_gray + variance_per_gray * light);
      const double noise = noise_gray > 0.0 ? noise_gray * random.normal() : 0.0;
      gray.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(background_gray + light + noise);
    }
  }
  return gray;
}

/// RMS error per coordinate over the sampling sigma that the dots state.
double error_without_noise_over_sampling_sigma(double least_radius_px, double most_radius_px) {
  Random random(1);
  DotFinder finder;
  double squares = 0.0;
  constexpr int dots = 1000;
  for (int i = 0; i < dots; ++i) {
    const OneDot dot = some_dot(random, least_radius_px, most_radius_px);
    const std::span<const Dot> found = finder.find(picture_of(dot, 0.0, 0.0, random));
    if (found.size() != 1U) return std::numeric_limits<double>::infinity();
    const double sampling_sigma_px = DotOptions{}.sampling_sigma_px2 / found.front().radius_px;
    squares += (found.front().center_px - dot.center_px).squaredNorm() / (2.0 * dots) /
               (sampling_sigma_px * sampling_sigma_px);
  }
  return std::sqrt(squares);
}

// The stated sampling_sigma_px2 is neither too small nor far too large, except for dots larger than at 1.5 m,
// where it is somewhat too small.
TEST(Dots, without_noise_a_middle_is_off_by_what_the_dot_says) {
  constexpr double radius_at_1500_mm_px = 5.0;
  for (const double radius_px : {1.9, 2.4, 3.0, 4.0, radius_at_1500_mm_px}) {
    const double ratio = error_without_noise_over_sampling_sigma(radius_px, 1.1 * radius_px);
    RecordProperty("ratio_at_" + std::to_string(radius_px), std::to_string(ratio));
    EXPECT_LT(ratio, radius_px < radius_at_1500_mm_px ? 1.0 : 1.7) << radius_px;
    EXPECT_GT(ratio, 0.25) << radius_px;
  }
}

/// Vignetting of the ceiling's light by 30 % from the frame's centre to its corner, 400 px away; this dot is
/// `from_middle_px` from the centre. The dot's own light does not fall, as it is near saturation.
cv::Mat where_light_falls_off(const OneDot& dot, double from_middle_px) {
  constexpr double fall_per_px2 = 0.3 / (400.0 * 400.0);
  const double slope_gray_per_px = -2.0 * fall_per_px2 * from_middle_px * background_gray;
  cv::Mat gray(side_px, side_px, CV_8UC1);
  for (int v = 0; v < side_px; ++v) {
    for (int u = 0; u < side_px; ++u) {
      const double around = background_gray + slope_gray_per_px * (u - dot.center_px.x());
      gray.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(
          around + share_at(dot, u, v) * (background_gray + contrast_gray - around));
    }
  }
  return gray;
}

// The pose estimate allows for this bias by scale_sigma.
TEST(Dots, are_pulled_to_the_middle_of_the_frame_by_light_that_falls_off_as_much_as_the_scale_says) {
  Random random(3);
  DotFinder finder;
  constexpr double from_middle_px = 175.0;
  double pull_px = 0.0;
  constexpr int dots = 2000;
  for (int i = 0; i < dots; ++i) {
    const OneDot dot = some_dot(random, 2.4, 3.2);
    const std::span<const Dot> found = finder.find(where_light_falls_off(dot, from_middle_px));
    ASSERT_EQ(found.size(), 1U);
    pull_px -= (found.front().center_px.x() - dot.center_px.x()) / dots;
  }
  RecordProperty("pull_px", std::to_string(pull_px));
  EXPECT_LT(pull_px, 1.2 * PoseFixOptions{}.scale_sigma * from_middle_px);
  EXPECT_GT(pull_px, 0.5 * PoseFixOptions{}.scale_sigma * from_middle_px);
}

/// An image with a dark ceiling joint, two pixels wide, 4 px to the right of the dot's centre.
cv::Mat with_joint(cv::Mat gray, const OneDot& dot) {
  for (int v = 0; v < side_px; ++v) {
    for (int u = 0; u < side_px; ++u) {
      const double across_px = u - dot.center_px.x() - 4.0;
      const double loss = 15.0 * std::exp(-0.5 * across_px * across_px);
      auto& pixel = gray.at<std::uint8_t>(v, u);
      pixel = cv::saturate_cast<std::uint8_t>(pixel - loss);
    }
  }
  return gray;
}

// A joint shifts a dot's centre the same way in every frame; the dot's stated sigma must allow for that.
TEST(Dots, say_what_a_joint_beside_them_may_do) {
  constexpr double dark_noise_gray = 1.5;
  Random random(5);
  DotFinder finder;
  double squared_error = 0.0;
  double squared_sigma = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const OneDot dot = some_dot(random, 2.4, 3.0);
    const cv::Mat plain = picture_of(dot, dark_noise_gray, 0.0, random);
    const double usual_sigma_px = finder.find(plain).front().sigma_px;
    const std::span<const Dot> found = finder.find(with_joint(plain, dot));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_GT(found.front().sigma_px, 1.5 * usual_sigma_px);
    squared_error += (found.front().center_px - dot.center_px).squaredNorm();
    squared_sigma += found.front().sigma_px * found.front().sigma_px;
  }
  RecordProperty("ratio", std::to_string(squared_error / (2.0 * squared_sigma)));
  EXPECT_LT(squared_error, 2.0 * 2.0 * squared_sigma);
  EXPECT_GT(squared_error, 0.1 * 2.0 * squared_sigma);
}

double learned_variance_per_gray(double dark_noise_gray, double variance_per_gray, std::uint64_t seed) {
  Random random(seed);
  constexpr double assumed_shot_noise_gray = 4.0;
  LightNoise noise(assumed_shot_noise_gray);
  for (int i = 0; i < 20000; ++i) {
    const OneDot dot = some_dot(random, 1.3, 2.0);
    noise.add(picture_of(dot, dark_noise_gray, variance_per_gray, random), dot.center_px, false,
              background_gray, dark_noise_gray);
  }
  return noise.variance_per_gray();
}

// Dots too small for a flat top also show the noise: those centred midway between pixels.
TEST(LightNoise, is_learned_from_small_dots) {
  constexpr double assumed = 16.0 / 255.0;
  EXPECT_LT(learned_variance_per_gray(4.0, 0.0, 2), 0.3 * assumed);
  EXPECT_NEAR(learned_variance_per_gray(2.0, 0.15, 3), 0.15, 0.02);
}

}  // namespace
}  // namespace lodestar
