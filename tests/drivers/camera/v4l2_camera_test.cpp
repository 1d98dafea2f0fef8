#include "drivers/camera/v4l2_camera.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <span>

#include "maps/input_error.hpp"

#include "tests/drivers/video_device_stand_in.hpp"

namespace lodestar {
namespace {

using ::testing::HasSubstr;

V4l2Camera camera_on(VideoScript& script, const V4l2CameraOptions& options = {}) {
  return {std::make_unique<VideoDeviceStandIn>(script), "/dev/video7", options};
}

/// Each pixel's gray is its index, line by line.
std::vector<std::uint8_t> counted(std::size_t bytes) {
  std::vector<std::uint8_t> result(bytes);
  for (std::size_t i = 0; i < bytes; ++i) result[i] = static_cast<std::uint8_t>(i);
  return result;
}

std::string refusal(VideoScript& script, const V4l2CameraOptions& options = {}) {
  try {
    const V4l2Camera camera = camera_on(script, options);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(V4l2Camera, prefers_gray_and_hands_out_frames_in_order) {
  VideoScript script;
  script.captures = {{.bytes = counted(32), .stamp = {.tv_sec = 7, .tv_usec = 250'000}},
                     {.bytes = std::vector<std::uint8_t>(32, 9), .stamp = {.tv_sec = 7, .tv_usec = 290'000}}};
  V4l2Camera camera = camera_on(script);
  EXPECT_EQ(script.chosen_format, V4L2_PIX_FMT_GREY);
  EXPECT_TRUE(script.streaming);

  const std::optional<Frame> first = camera.poll();
  const std::optional<Frame> second = camera.poll();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->gray.size(), cv::Size(8, 4));
  EXPECT_EQ(first->gray.at<std::uint8_t>(2, 3), 19) << "unchanged by the next frame";
  EXPECT_EQ(second->gray.at<std::uint8_t>(0, 0), 9);
  EXPECT_EQ(first->stamp, Stamp(std::chrono::milliseconds(7250)));
  EXPECT_FALSE(camera.poll());
  EXPECT_FALSE(camera.lost()) << "no frame is not a lost camera";
}

TEST(V4l2Camera, goes_on_for_longer_than_it_has_buffers) {
  VideoScript script;
  for (int i = 0; i < 25; ++i) script.captures.push_back({.bytes = counted(32)});
  V4l2Camera camera = camera_on(script);
  int frames = 0;
  while (camera.poll()) ++frames;
  EXPECT_EQ(frames, 25);
}

TEST(V4l2Camera, stamps_the_middle_of_the_exposure) {
  constexpr auto monotonic = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  VideoScript script;
  script.exposure_100us = 80;  // 8 ms
  script.captures = {{counted(32), monotonic | V4L2_BUF_FLAG_TSTAMP_SRC_SOE, {.tv_sec = 1, .tv_usec = 0}},
                     {counted(32), monotonic | V4L2_BUF_FLAG_TSTAMP_SRC_EOF, {.tv_sec = 1, .tv_usec = 0}},
                     {counted(32), V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN, {.tv_sec = 1, .tv_usec = 0}}};
  V4l2Camera camera = camera_on(script, {.latency = std::chrono::milliseconds(30)});
  EXPECT_EQ(camera.poll()->stamp, Stamp(std::chrono::milliseconds(1004)))
      << "stamped at the start of the exposure";
  EXPECT_EQ(camera.poll()->stamp, Stamp(std::chrono::milliseconds(1000 - 30 - 4)))
      << "stamped at the frame's end";
  EXPECT_EQ(camera.poll()->stamp, Stamp(std::chrono::milliseconds(50'000 - 30 - 4)))
      << "no stamp: from the arrival";
}

/// uvcvideo flags the start of exposure with every camera, and stamps what comes after it.
TEST(V4l2Camera, stamps_the_middle_of_the_exposure_before_a_stamp_of_arrival_that_is_flagged_as_its_start) {
  VideoScript script;
  script.driver = "uvcvideo";
  script.exposure_100us = 80;
  script.captures = {{.bytes = counted(32), .stamp = {.tv_sec = 1, .tv_usec = 0}},
                     {.bytes = counted(32), .stamp = {.tv_sec = 2, .tv_usec = 0}}};
  V4l2Camera camera = camera_on(script);
  EXPECT_EQ(camera.poll()->stamp, Stamp(std::chrono::milliseconds(1000 - 4)));
  EXPECT_THAT(camera.description(), HasSubstr("flagged as start of exposure, taken as arrival"));

  V4l2Camera told = camera_on(script, {.stamped_at = StampedAt::exposure_start});
  EXPECT_EQ(told.poll()->stamp, Stamp(std::chrono::milliseconds(2000 + 4))) << "its user knows better";
}

/// The exposure of a frame has ended before the frame arrives.
TEST(V4l2Camera, does_not_believe_a_start_of_exposure_that_leaves_no_time_for_it) {
  VideoScript script;
  script.exposure_100us = 200;
  script.now = Stamp(std::chrono::milliseconds(1015));
  script.captures = {{.bytes = counted(32), .stamp = {.tv_sec = 1, .tv_usec = 0}}};
  V4l2Camera camera = camera_on(script);
  EXPECT_EQ(camera.poll()->stamp, Stamp(std::chrono::milliseconds(1000 - 10)));
}

TEST(V4l2Camera, follows_an_exposure_that_changes_by_itself) {
  VideoScript script;
  script.exposure_100us = 80;
  script.exposure_mode = V4L2_EXPOSURE_APERTURE_PRIORITY;
  for (int i = 0; i < 2; ++i)
    script.captures.push_back({.bytes = counted(32), .stamp = {.tv_sec = 1, .tv_usec = 0}});
  V4l2Camera camera = camera_on(script);
  EXPECT_EQ(camera.poll()->stamp, Stamp(std::chrono::milliseconds(1004)));
  script.exposure_100us = 160;
  script.now += std::chrono::seconds(1);
  EXPECT_EQ(camera.poll()->stamp, Stamp(std::chrono::milliseconds(1008)));
  EXPECT_THAT(camera.description(), HasSubstr("exposure 16.0 ms (automatic)"));
}

TEST(V4l2Camera, takes_its_settings) {
  VideoScript script;
  script.exposure_100us = 300;
  script.exposure_mode = V4L2_EXPOSURE_APERTURE_PRIORITY;
  script.gain = 64;
  script.frame_time = {.numerator = 1, .denominator = 30};
  const V4l2Camera camera =
      camera_on(script, {.exposure = std::chrono::microseconds(2500), .gain = 12, .rate_hz = 25.0});
  EXPECT_EQ(script.exposure_mode, V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(script.exposure_100us, 25);
  EXPECT_EQ(script.gain, 12);
  EXPECT_THAT(camera.description(), HasSubstr("8 x 4 GREY, 25 frames a second, exposure 2.5 ms (fixed)"));
}

TEST(V4l2Camera, refuses_a_setting_that_the_camera_does_not_take) {
  VideoScript script;
  EXPECT_THAT(refusal(script, {.exposure = std::chrono::milliseconds(3)}),
              HasSubstr("found a camera whose exposure cannot be set, wanted 3.0 ms"));
  EXPECT_THAT(refusal(script, {.gain = 3}),
              HasSubstr("found a camera whose gain cannot be set, wanted a gain of 3"));
  EXPECT_THAT(refusal(script, {.rate_hz = 60.0}),
              HasSubstr("found a camera whose frame rate cannot be set, wanted 60 frames a second"));
  script.exposure_100us = 300;
  script.least_exposure_100us = 50;
  EXPECT_THAT(refusal(script, {.exposure = std::chrono::milliseconds(3)}),
              HasSubstr("found an exposure of 5.0 ms, wanted 3.0 ms"));
  script.frame_time = {.numerator = 1, .denominator = 30};
  EXPECT_THAT(refusal(script, {.rate_hz = 200.0}),
              HasSubstr("found 100 frames a second, wanted 200 frames a second"));
}

TEST(V4l2Camera, leaves_out_damaged_and_short_frames) {
  VideoScript script;
  script.captures = {{.bytes = counted(32), .flags = V4L2_BUF_FLAG_ERROR},
                     {.bytes = counted(31)},
                     {.bytes = counted(32), .stamp = {.tv_sec = 3, .tv_usec = 0}}};
  V4l2Camera camera = camera_on(script);
  EXPECT_EQ(camera.poll()->stamp, Stamp(std::chrono::seconds(3)));
}

TEST(V4l2Camera, skips_the_padding_after_each_line) {
  VideoScript script;
  script.padding = 5;
  script.captures = {{.bytes = counted(4 * 13)}};
  EXPECT_EQ(camera_on(script).poll()->gray.at<std::uint8_t>(2, 1), 27);
}

TEST(V4l2Camera, says_when_it_is_gone) {
  VideoScript script;
  V4l2Camera camera = camera_on(script);
  script.captures = {{.bytes = counted(32)}};
  script.unplugged = true;
  EXPECT_FALSE(camera.poll());
  EXPECT_TRUE(camera.lost());
  script.unplugged = false;
  EXPECT_FALSE(camera.poll()) << "a lost camera stays lost";
}

TEST(V4l2Camera, stops_and_closes_at_the_end) {
  VideoScript script;
  {
    const V4l2Camera camera = camera_on(script);
  }
  EXPECT_FALSE(script.streaming);
  EXPECT_TRUE(script.closed);
}

TEST(V4l2Camera, refuses_what_it_cannot_use_by_name) {
  VideoScript output;
  output.capabilities = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_STREAMING;
  EXPECT_THAT(refusal(output), HasSubstr("/dev/video7: found a video device that does not capture"));
  VideoScript strange;
  strange.formats = {V4L2_PIX_FMT_H264};
  EXPECT_THAT(refusal(strange), HasSubstr("found pixel formats H264 only"));
  VideoScript used;
  used.in_use = true;
  EXPECT_THAT(refusal(used), HasSubstr("found a camera that is in use"));
  VideoScript small;
  EXPECT_THAT(refusal(small, {.width_px = 640, .height_px = 480}),
              HasSubstr("found 8 x 4 pixels, wanted 640 x 480"));
  VideoScript none;
  none.unplugged = true;
  EXPECT_THAT(refusal(none), HasSubstr("found no video device"));
}

TEST(V4l2Pixels, full_gray_comes_of_limited_luma_in_every_layout) {
  // Two pixels: black and white of BT.601, 16 and 235, with colour between that must not matter.
  V4l2Layout layout{.fourcc = V4L2_PIX_FMT_YUYV, .width_px = 2, .height_px = 1, .bytes_per_line = 4};
  const std::vector<std::uint8_t> yuyv{16, 77, 235, 99};
  const std::vector<std::uint8_t> uyvy{77, 16, 99, 235};
  const std::vector<std::uint8_t> nv12{16, 235, 77, 99};
  for (const auto& [fourcc, bytes] :
       {std::pair(V4L2_PIX_FMT_YUYV, yuyv), {V4L2_PIX_FMT_UYVY, uyvy}, {V4L2_PIX_FMT_NV12, nv12}}) {
    layout.fourcc = fourcc;
    layout.bytes_per_line = fourcc == V4L2_PIX_FMT_NV12 ? 2 : 4;
    const cv::Mat gray = gray_of(layout, bytes);
    ASSERT_EQ(gray.size(), cv::Size(2, 1)) << fourcc_name(fourcc);
    EXPECT_EQ(gray.at<std::uint8_t>(0, 0), 0) << fourcc_name(fourcc);
    EXPECT_EQ(gray.at<std::uint8_t>(0, 1), 255) << fourcc_name(fourcc);
  }
  layout.limited_luma = false;
  layout.fourcc = V4L2_PIX_FMT_YUYV;
  layout.bytes_per_line = 4;
  EXPECT_EQ(gray_of(layout, yuyv).at<std::uint8_t>(0, 1), 235);
}

TEST(V4l2Pixels, deep_gray_keeps_its_highest_bits) {
  V4l2Layout layout{.fourcc = V4L2_PIX_FMT_Y10, .width_px = 1, .height_px = 1, .bytes_per_line = 2};
  const std::vector<std::uint8_t> low_byte_first{0x24, 0x03};  // 0x324 = 804 of 1023
  EXPECT_EQ(gray_of(layout, low_byte_first).at<std::uint8_t>(0, 0), 804 / 4);
  layout.fourcc = V4L2_PIX_FMT_Y12;
  EXPECT_EQ(gray_of(layout, low_byte_first).at<std::uint8_t>(0, 0), 804 / 16);
  layout.fourcc = V4L2_PIX_FMT_Y16;
  EXPECT_EQ(gray_of(layout, low_byte_first).at<std::uint8_t>(0, 0), 804 / 256);
}

TEST(V4l2Pixels, depths_stay_as_they_are_in_rows_that_are_padded) {
  const V4l2Layout layout{.fourcc = V4L2_PIX_FMT_Z16, .width_px = 2, .height_px = 2, .bytes_per_line = 6};
  const std::vector<std::uint8_t> bytes{0xe8, 0x03, 0x00, 0x00, 9, 9, 0xff, 0xff, 0x01, 0x00, 9, 9};
  const cv::Mat depth = gray_of(layout, bytes);
  ASSERT_EQ(depth.type(), CV_16UC1);
  EXPECT_EQ(depth.at<std::uint16_t>(0, 0), 1000);
  EXPECT_EQ(depth.at<std::uint16_t>(0, 1), 0);
  EXPECT_EQ(depth.at<std::uint16_t>(1, 0), 65535);
  EXPECT_EQ(depth.at<std::uint16_t>(1, 1), 1);
  EXPECT_TRUE(gray_of(layout, std::span(bytes).first(9)).empty()) << "cut short";
}

TEST(V4l2Camera, of_depths_wants_them_and_no_gray) {
  V4l2CameraOptions options;
  options.depth = true;
  VideoScript gray;
  EXPECT_THAT(refusal(gray, options), HasSubstr("wanted depths of 16 bits (Z16)"));
  VideoScript depth;
  depth.formats = {V4L2_PIX_FMT_Z16};
  depth.captures = {{.bytes = std::vector<std::uint8_t>(64, 1)}};
  V4l2Camera camera = camera_on(depth, options);
  EXPECT_EQ(depth.chosen_format, V4L2_PIX_FMT_Z16);
  EXPECT_EQ(camera.poll()->gray.at<std::uint16_t>(0, 0), 257);
  VideoScript other;
  other.formats = {V4L2_PIX_FMT_Z16};
  EXPECT_THAT(refusal(other), HasSubstr("wanted gray, YUV or JPEG")) << "a depth is no picture of markers";
}

TEST(V4l2Pixels, a_jpeg_of_another_size_is_no_frame) {
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", cv::Mat(16, 24, CV_8UC1, cv::Scalar(120)), jpeg);
  V4l2Layout layout{.fourcc = V4L2_PIX_FMT_MJPEG, .width_px = 24, .height_px = 16};
  EXPECT_EQ(gray_of(layout, jpeg).at<std::uint8_t>(8, 8), 120);
  layout.width_px = 32;
  EXPECT_TRUE(gray_of(layout, jpeg).empty());
  EXPECT_TRUE(gray_of(layout, {}).empty());
}

}  // namespace
}  // namespace lodestar
