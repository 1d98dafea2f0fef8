#include "localization/confidence.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "maps/random.hpp"

namespace lodestar {
namespace {

TEST(GrayFrequency, has_the_extremes_that_the_paper_names) {
  double highest = 0.0;
  for (double gray = 200.0; gray <= 255.0; gray += 0.01) highest = std::max(highest, gray_frequency(gray));
  EXPECT_NEAR(highest, confidence_max, 0.05);
  EXPECT_NEAR(gray_frequency(245.06), confidence_max, 0.05);
  EXPECT_NEAR(gray_frequency(200.0), confidence_min, 0.05);
  for (int gray = 200; gray <= 255; ++gray) EXPECT_GE(gray_frequency(gray), confidence_min);
}

TEST(MarkerConfidence, is_equation_3_evaluated_pixel_by_pixel) {
  Random random(11);
  GrayHistogram histogram{};
  double sum = 0.0;
  const int pixels = 500;
  for (int i = 0; i < pixels; ++i) {
    const auto gray = 200 + static_cast<int>(random.below(56));
    ++histogram[static_cast<std::size_t>(gray)];
    const double f = 2634.0 * std::exp(-std::pow(gray - 245.4, 2) / 196.84) +
                     525.0 * std::exp(-std::pow(gray - 208.6, 2) / 791.30);
    sum += (f - 478.2) / (2730.3 - 478.2);
  }
  EXPECT_NEAR(marker_confidence(histogram), sum / pixels, 1e-12);
}

TEST(MarkerConfidence, is_one_at_the_most_frequent_gray_and_zero_at_200) {
  GrayHistogram histogram{};
  histogram[245] = 40;
  EXPECT_NEAR(marker_confidence(histogram), 1.0, 1e-4);
  histogram[245] = 0;
  histogram[200] = 40;
  EXPECT_NEAR(marker_confidence(histogram), 0.0, 1e-4);
}

TEST(MarkerConfidence, counts_darker_pixels_in_n_only) {
  GrayHistogram histogram{};
  histogram[245] = 30;
  histogram[150] = 10;
  EXPECT_NEAR(marker_confidence(histogram), 0.75, 1e-4);
}

TEST(MarkerConfidence, of_no_pixels_is_zero) {
  EXPECT_EQ(marker_confidence({}), 0.0);
}

}  // namespace
}  // namespace lodestar
