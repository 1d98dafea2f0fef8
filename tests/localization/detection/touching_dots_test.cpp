#include "localization/detection/touching_dots.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <gtest/gtest.h>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace lodestar {
namespace {

constexpr double pitch_px = 10.0;
constexpr double radius_px = 2.5;  ///< of the printed dots
constexpr double background_gray = 100.0;
constexpr double contrast_gray = 120.0;
constexpr double noise_gray = 2.0;
constexpr std::size_t middle = 4;  ///< of the nine dots

/// Three by three dots, a pitch apart, as measured alone with this radius.
std::vector<Dot> nine_dots(double measured_radius_px) {
  std::vector<Dot> dots;
  for (int row = 1; row <= 3; ++row)
    for (int column = 1; column <= 3; ++column)
      dots.push_back({.center_px = pitch_px * Vec2(column, row),
                      .radius_px = measured_radius_px,
                      .background_gray = background_gray + 3.0,
                      .contrast_gray = contrast_gray});
  return dots;
}

cv::Mat picture_of(const std::vector<Dot>& dots, double blur_sigma_px) {
  cv::Mat gray(40, 40, CV_8UC1);
  for (int v = 0; v < gray.rows; ++v) {
    for (int u = 0; u < gray.cols; ++u) {
      double light = background_gray;
      for (const Dot& dot : dots) {
        const double outside_px = (Vec2(u, v) - dot.center_px).norm() - radius_px;
        light += contrast_gray * 0.5 * std::erfc(outside_px / (std::sqrt(2.0) * blur_sigma_px));
      }
      gray.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(light);
    }
  }
  return gray;
}

/// A fit changes the background of each dot that takes part.
std::ptrdiff_t fitted(const cv::Mat& gray, std::vector<Dot> dots) {
  const double before = dots.front().background_gray;
  TouchingDots().fit(gray, noise_gray, 0.0, dots);
  return std::ranges::count_if(dots, [&](const Dot& dot) { return dot.background_gray != before; });
}

TEST(TouchingDots, that_are_blurred_are_fitted_together) {
  const std::vector<Dot> dots = nine_dots(1.15 * radius_px);
  EXPECT_EQ(fitted(picture_of(dots, 1.8), dots), 9);
}

TEST(TouchingDots, that_are_sharp_do_not_touch) {
  const std::vector<Dot> dots = nine_dots(radius_px);
  EXPECT_EQ(fitted(picture_of(dots, 0.6), dots), 0);
}

TEST(TouchingDots, one_that_looks_larger_than_all_about_it_touches_none) {
  std::vector<Dot> dots = nine_dots(radius_px);
  dots[middle].radius_px *= 1.15;
  EXPECT_EQ(fitted(picture_of(dots, 0.6), dots), 0);
}

TEST(TouchingDots, two_alone_touch_when_both_are_as_large) {
  std::vector<Dot> dots = nine_dots(1.15 * radius_px);
  dots.resize(2);
  EXPECT_EQ(fitted(picture_of(dots, 1.8), dots), 2);
}

}  // namespace
}  // namespace lodestar
