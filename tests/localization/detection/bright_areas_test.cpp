#include "localization/detection/bright_areas.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "localization/detection/sixteen_pixels.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

cv::Mat random_frame(Random& random, cv::Size size, double bright_share) {
  cv::Mat frame(size, CV_8UC1);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const bool bright = random.uniform() < bright_share;
      frame.at<std::uint8_t>(v, u) =
          static_cast<std::uint8_t>(bright ? 200 + random.below(56) : random.below(200));
    }
  }
  return frame;
}

TEST(SixteenPixels, have_the_same_bits_with_and_without_an_instruction_for_it) {
  Random random(3);
  for (int frame = 0; frame < 1000; ++frame) {
    const cv::Mat row = random_frame(random, {16, 1}, 0.5);
    const SixteenAnswers bright = sixteen_at(row.ptr<std::uint8_t>(0)) >= std::uint8_t{200};
    std::uint32_t expected = 0;
    for (unsigned i = 0; i < 16; ++i)
      expected |= (row.at<std::uint8_t>(0, static_cast<int>(i)) >= 200 ? 1U : 0U) << i;
    EXPECT_EQ(bits_of(bright), expected);
    EXPECT_EQ(packed_bits_of(bright), expected);
  }
}

cv::Mat thresholded(const cv::Mat& frame) {
  cv::Mat binary;
  cv::threshold(frame, binary, 199.0, 255.0, cv::THRESH_BINARY);
  return binary;
}

LocalThresholds fixed_threshold(const cv::Mat& frame) {
  LocalThresholds thresholds;
  thresholds.set(frame.size(), 200);
  return thresholds;
}

cv::Mat drawn(std::span<const Run> runs, cv::Size size) {
  cv::Mat image = cv::Mat::zeros(size, CV_8UC1);
  for (const Run& run : runs) image.row(run.row).colRange(run.begin, run.end) = 255;
  return image;
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_INF) == 0.0;
}

// Widths around the 64 pixels that are processed together; sparse and dense frames.
class RandomFrames : public testing::TestWithParam<std::tuple<int, double>> {
 protected:
  Random random_{static_cast<std::uint64_t>(std::get<0>(GetParam()))};
  cv::Size size_{std::get<0>(GetParam()), 40};
  cv::Mat frame_ = random_frame(random_, size_, std::get<1>(GetParam()));
};

TEST_P(RandomFrames, runs_are_the_thresholded_image) {
  BrightAreaFinder finder;
  finder.find(frame_, fixed_threshold(frame_));
  EXPECT_TRUE(same(drawn(finder.runs(), size_), thresholded(frame_)));
}

TEST_P(RandomFrames, areas_are_those_of_opencv) {
  BrightAreaFinder finder;
  const BrightAreas& areas = finder.find(frame_, fixed_threshold(frame_));
  cv::Mat labels, stats, centers;
  const int count = cv::connectedComponentsWithStats(thresholded(frame_), labels, stats, centers, 8);
  ASSERT_EQ(static_cast<int>(areas.areas.size()), count - 1);
  for (const BrightArea& area : areas.areas) {
    const lodestar::Run& first = areas.runs_of(area).front();
    const int label = labels.at<int>(first.row, first.begin);
    EXPECT_EQ(area.area_px, stats.at<int>(label, cv::CC_STAT_AREA));
    EXPECT_NEAR(area.mean_u_px, centers.at<double>(label, 0), 1e-9);
    EXPECT_NEAR(area.mean_v_px, centers.at<double>(label, 1), 1e-9);
    for (const lodestar::Run& run : areas.runs_of(area)) EXPECT_EQ(labels.at<int>(run.row, run.begin), label);
  }
}

TEST_P(RandomFrames, erosion_area_by_area_is_that_of_the_whole_image) {
  BrightAreaFinder finder;
  const BrightAreas& areas = finder.find(frame_, fixed_threshold(frame_));
  Eroder eroder;
  for (const int side : {1, 3, 5}) {
    cv::Mat ours = cv::Mat::zeros(size_, CV_8UC1);
    for (const BrightArea& area : areas.areas) ours |= drawn(eroder.erode(areas.runs_of(area), side), size_);
    cv::Mat whole;
    cv::erode(thresholded(frame_), whole, cv::getStructuringElement(cv::MORPH_CROSS, {side, side}), {-1, -1},
              1, cv::BORDER_CONSTANT, cv::Scalar(0));
    EXPECT_TRUE(same(ours, whole)) << "side " << side;
  }
}

INSTANTIATE_TEST_SUITE_P(widths_and_shares, RandomFrames,
                         testing::Combine(testing::Values(1, 63, 64, 65, 130, 200),
                                          testing::Values(0.0, 0.05, 0.5, 0.9, 1.0)));

TEST(BrightAreas, aspect_ratio_tells_a_tube_at_any_angle_from_a_dot) {
  cv::Mat frame = cv::Mat::zeros(200, 200, CV_8UC1);
  cv::circle(frame, {40, 40}, 6, 255, cv::FILLED);
  cv::line(frame, {80, 80}, {140, 140}, 255, 5);
  BrightAreaFinder finder;
  const BrightAreas& areas = finder.find(frame, fixed_threshold(frame));
  ASSERT_EQ(areas.areas.size(), 2U);
  EXPECT_NEAR(areas.areas[0].aspect_ratio, 1.0, 0.05);
  EXPECT_GT(areas.areas[1].aspect_ratio, 8.0);
}

}  // namespace
}  // namespace lodestar
