#include "app/drive/range_findings.hpp"

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

namespace lodestar {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Robot robot() {
  Robot robot;
  robot.scanner.emplace();
  robot.depth_camera.emplace();
  return robot;
}

/// Ten a second, 30 ms old on arrival.
SeenRanges scans(int count, Echo echo = Echo::hit) {
  SeenRanges seen;
  for (int i = 0; i < count; ++i) {
    const Stamp stamp(milliseconds(1000 + 100 * i));
    seen.take(Scan{.beams = std::vector<Beam>(720, Beam{.stamp = stamp, .echo = echo})},
              stamp + milliseconds(30));
  }
  return seen;
}

TEST(RangeFindings, say_nothing_of_a_robot_that_has_neither) {
  EXPECT_THAT(look_at_ranges(Robot{}, {}), IsEmpty());
}

TEST(RangeFindings, tell_rate_age_and_what_the_scanner_says) {
  SeenRanges seen = scans(8);
  seen.description = "LD19";
  seen.take(DepthImage{.depth_mm = cv::Mat(4, 4, CV_16UC1, cv::Scalar(1000))});
  const std::vector<Finding> findings = look_at_ranges(robot(), seen);
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_EQ(findings[0].verdict, Verdict::good);
  EXPECT_THAT(findings[0].found,
              HasSubstr("720 beams a scan, 30 ms old on arrival, 10.0 scans a second; it says: LD19"));
  EXPECT_EQ(findings[1].verdict, Verdict::good);
  EXPECT_THAT(findings[1].found, HasSubstr("a depth for 100 % of the pixels"));
}

TEST(RangeFindings, name_what_is_missing_or_doubtful) {
  SeenRanges none;
  none.no_scanner = "/dev/ttyUSB0: found no such device, wanted a serial line";
  EXPECT_EQ(look_at_ranges(robot(), none)[0].verdict, Verdict::bad);
  EXPECT_EQ(look_at_ranges(robot(), none)[0].found, none.no_scanner);
  EXPECT_EQ(look_at_ranges(robot(), none)[1].found, "no image in a second");

  SeenRanges damaged = scans(8);
  damaged.packets = {.read = 100, .refused = 3};
  EXPECT_EQ(look_at_ranges(robot(), damaged)[0].verdict, Verdict::doubtful);
  EXPECT_THAT(look_at_ranges(robot(), damaged)[0].found, HasSubstr("3 of its packets were damaged"));
  EXPECT_THAT(look_at_ranges(robot(), scans(8, Echo::invalid))[0].remedy, HasSubstr("clean its window"));

  SeenRanges dark = scans(8);
  dark.take(DepthImage{.depth_mm = cv::Mat::zeros(4, 4, CV_16UC1)});
  EXPECT_EQ(look_at_ranges(robot(), dark)[1].verdict, Verdict::doubtful);
}

}  // namespace
}  // namespace lodestar
