#include "localization/dots.hpp"

#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>

#include "localization/light_noise.hpp"
#include "localization/pose_fix.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

constexpr int side_px = 32;
constexpr double background_gray = 35.0;
constexpr double contrast_gray = 190.0;

/// A disc and where it is.
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

/// Its light by formula, so that nothing but whole gray values keeps its middle from being exact; and noise.
cv::Mat picture_of(const OneDot& dot, double dark_noise_gray, double variance_per_gray, Random& random) {
  cv::Mat gray(side_px, side_px, CV_8UC1);
  for (int v = 0; v < side_px; ++v) {
    for (int u = 0; u < side_px; ++u) {
      const double outside_px = (Vec2(u, v) - dot.center_px).norm() - dot.radius_px;
      const double light = contrast_gray * 0.5 * std::erfc(outside_px / (std::sqrt(2.0) * dot.blur_sigma_px));
      const double noise_gray = std::sqrt(dark_noise_gray * dark_noise_gray + variance_per_gray * light);
      const double noise = noise_gray > 0.0 ? noise_gray * random.normal() : 0.0;
      gray.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(background_gray + light + noise);
    }
  }
  return gray;
}

// What the pose is told of it (model_sigma_px) is neither too little nor far too much.
TEST(Dots, without_noise_a_middle_is_off_by_what_the_model_says) {
  Random random(1);
  DotFinder finder;
  double squared_error = 0.0;
  constexpr int dots = 1000;
  for (int i = 0; i < dots; ++i) {
    const OneDot dot = some_dot(random, 1.9, 4.5);
    const std::span<const Dot> found = finder.find(picture_of(dot, 0.0, 0.0, random));
    ASSERT_EQ(found.size(), 1U);
    squared_error += (found.front().center_px - dot.center_px).squaredNorm();
  }
  const double sigma_px = std::sqrt(0.5 * squared_error / dots);
  RecordProperty("sigma_px", std::to_string(sigma_px));
  EXPECT_LT(sigma_px, PoseFixOptions{}.model_sigma_px);
  EXPECT_GT(sigma_px, 0.25 * PoseFixOptions{}.model_sigma_px);
}

/// The same with a dark joint of the ceiling, two pixels wide, that passes 4 px right of the dot's middle.
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

// A joint pulls a dot's middle alike in every frame. The dot says that it is less sure, and by how much.
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

// Dots too small to be flat tell it too, by those that lie midway between pixels.
TEST(LightNoise, is_learned_from_small_dots) {
  constexpr double assumed = 16.0 / 255.0;
  EXPECT_LT(learned_variance_per_gray(4.0, 0.0, 2), 0.3 * assumed);
  EXPECT_NEAR(learned_variance_per_gray(2.0, 0.15, 3), 0.15, 0.02);
}

}  // namespace
}  // namespace lodestar
