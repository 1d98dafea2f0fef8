#include "app/drive/camera_findings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lodestar {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

/// 40 ms apart, 12 ms old on arrival.
SeenImages images(int count) {
  SeenImages seen;
  for (int i = 0; i < count; ++i) {
    const Stamp stamp(milliseconds(1000 + 40 * i));
    seen.take(stamp, stamp + milliseconds(12));
  }
  return seen;
}

TEST(CameraFindings, tell_the_rate_by_the_stamps_and_what_the_driver_claims) {
  SeenImages seen = images(20);
  seen.description = "uvcvideo: 640 x 480 GREY";
  const std::vector<Finding> findings = look_at_images(Site{}, seen);
  EXPECT_EQ(findings.front().verdict, Verdict::good);
  EXPECT_THAT(findings.front().found, HasSubstr("25.0 a second by their stamps, 12 ms old on arrival"));
  EXPECT_THAT(findings.front().found, HasSubstr("the driver claims uvcvideo: 640 x 480 GREY"));
}

TEST(CameraFindings, doubt_a_camera_that_is_slower_than_it_was_set_to_be) {
  Site site;
  site.camera_settings.rate_hz = 30.0;
  EXPECT_EQ(look_at_images(site, images(20)).front().verdict, Verdict::doubtful);
  site.camera_settings.rate_hz = 26.0;
  EXPECT_EQ(look_at_images(site, images(20)).front().verdict, Verdict::good);
}

}  // namespace
}  // namespace lodestar
