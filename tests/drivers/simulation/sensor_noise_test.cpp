#include "drivers/simulation/sensor_noise.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

LightImage even_light(double gray) {
  LightImage light(640, 480);
  for (int v = 0; v < light.height_px(); ++v) {
    std::fill_n(light.row(v), light.width_px(),
                static_cast<std::int16_t>(std::lround(gray * LightImage::units_per_gray)));
  }
  return light;
}

cv::Mat1d exposed(const SensorNoise& noise, double gray, std::uint64_t frame) {
  cv::Mat1d values;
  noise.expose(even_light(gray), frame).convertTo(values, CV_64F);
  return values;
}

TEST(SensorNoise, has_mean_zero_and_the_deviation_of_read_and_shot_noise) {
  const double read = 2.0;
  const double shot = 4.0;
  const SensorNoise noise(read, shot, 1);
  for (const double gray : {20.0, 35.0, 80.0, 150.0, 200.0, 230.0}) {
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(exposed(noise, gray, 3), mean, deviation);
    const double rounding_variance = 1.0 / 12.0;
    const double expected = std::sqrt(read * read + shot * shot * gray / 255.0 + rounding_variance);
    EXPECT_NEAR(mean[0], gray, 0.05) << "gray " << gray;
    EXPECT_NEAR(deviation[0], expected, 0.02 * expected) << "gray " << gray;
  }
}

TEST(SensorNoise, of_pure_shot_noise_follows_the_square_root) {
  const SensorNoise noise(0.0, 6.0, 1);
  for (const double gray : {60.0, 120.0, 200.0}) {
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(exposed(noise, gray, 3), mean, deviation);
    EXPECT_NEAR(deviation[0], std::sqrt(36.0 * gray / 255.0 + 1.0 / 12.0), 0.15) << "gray " << gray;
  }
}

TEST(SensorNoise, is_gaussian) {
  const cv::Mat1d values = exposed(SensorNoise(4.0, 0.0, 2), 128.0, 5);
  int beyond_two_sigma = 0;
  int beyond_three_sigma = 0;
  for (const double value : values) {
    // 2 and 3 sigma plus half a gray level, as values are rounded: 9 stands for all from 8.5 on.
    if (std::abs(value - 128.0) > 8.5) ++beyond_two_sigma;
    if (std::abs(value - 128.0) > 12.5) ++beyond_three_sigma;
  }
  const auto count = static_cast<double>(values.total());
  EXPECT_NEAR(beyond_two_sigma / count, std::erfc(8.5 / 4.0 / std::sqrt(2.0)), 0.003);
  EXPECT_NEAR(beyond_three_sigma / count, std::erfc(12.5 / 4.0 / std::sqrt(2.0)), 0.0006);
}

/// Correlation of one frame's noise with that of another, shifted.
double correlation(const cv::Mat1d& a, const cv::Mat1d& b, int right, int down) {
  const cv::Rect here(0, 0, a.cols - right, a.rows - down);
  cv::Mat1d x;
  cv::Mat1d y;
  cv::subtract(a(here), cv::mean(a), x);
  cv::subtract(b(here + cv::Point(right, down)), cv::mean(b), y);
  return x.dot(y) / std::sqrt(x.dot(x) * y.dot(y));
}

TEST(SensorNoise, does_not_repeat_from_pixel_to_pixel_row_to_row_or_frame_to_frame) {
  const SensorNoise noise(4.0, 0.0, 3);
  const cv::Mat1d first = exposed(noise, 128.0, 1);
  const cv::Mat1d second = exposed(noise, 128.0, 2);
  constexpr double chance = 0.012;
  for (const auto& [right, down] : {std::pair{1, 0}, {2, 0}, {16, 0}, {0, 1}, {1, 1}, {0, 2}, {7, 3}}) {
    EXPECT_LT(std::abs(correlation(first, first, right, down)), chance) << right << ' ' << down;
  }
  EXPECT_LT(std::abs(correlation(first, second, 0, 0)), chance);
}

TEST(SensorNoise, cuts_at_black_and_white) {
  const SensorNoise noise(2.0, 4.0, 4);
  double lowest = 0.0;
  double highest = 0.0;
  cv::minMaxLoc(exposed(noise, LightImage::brightest_gray, 1), &lowest, &highest);
  EXPECT_EQ(lowest, 255.0);
  EXPECT_EQ(highest, 255.0);
  cv::minMaxLoc(exposed(noise, 0.0, 1), &lowest, &highest);
  EXPECT_EQ(lowest, 0.0);
}

TEST(SensorNoise, without_noise_only_rounds) {
  const SensorNoise noise(0.0, 0.0, 5);
  EXPECT_EQ(exposed(noise, 99.4, 1)(7, 7), 99.0);
  EXPECT_EQ(exposed(noise, 99.6, 1)(7, 7), 100.0);
}

TEST(SensorNoise, refuses_more_than_its_fixed_point_holds) {
  EXPECT_THROW(SensorNoise(20.0, 0.0, 1), InputError);
}

}  // namespace
}  // namespace lodestar
