#include "localization/detection/confidence.hpp"

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

ConfidenceSum of_pixels(std::uint8_t gray, int count, ConfidenceSum sum = {}) {
  for (int i = 0; i < count; ++i) sum.add(gray);
  return sum;
}

TEST(MarkerConfidence, is_equation_3_evaluated_pixel_by_pixel) {
  Random random(11);
  ConfidenceSum confidence;
  double sum = 0.0;
  const int pixels = 500;
  for (int i = 0; i < pixels; ++i) {
    const auto gray = 200 + static_cast<int>(random.below(56));
    confidence.add(static_cast<std::uint8_t>(gray));
    const double f = 2634.0 * std::exp(-std::pow(gray - 245.4, 2) / 196.84) +
                     525.0 * std::exp(-std::pow(gray - 208.6, 2) / 791.30);
    sum += (f - 478.2) / (2730.3 - 478.2);
  }
  EXPECT_NEAR(confidence.value(), sum / pixels, 1e-12);
}

TEST(MarkerConfidence, is_one_at_the_most_frequent_gray_and_zero_at_200) {
  EXPECT_NEAR(of_pixels(245, 40).value(), 1.0, 1e-4);
  EXPECT_NEAR(of_pixels(200, 40).value(), 0.0, 1e-4);
}

TEST(MarkerConfidence, counts_darker_pixels_in_n_only) {
  EXPECT_NEAR(of_pixels(150, 10, of_pixels(245, 30)).value(), 0.75, 1e-4);
}

TEST(MarkerConfidence, of_no_pixels_is_zero) {
  EXPECT_EQ(ConfidenceSum{}.value(), 0.0);
}

}  // namespace
}  // namespace lodestar
