#include "localization/integrity/camera_watch.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "maps/random.hpp"

namespace lodestar {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Stamp noon{std::chrono::hours(12)};

Frame frame_at(Stamp stamp, std::uint64_t noise, int gray = 100) {
  Random random(noise);
  Frame frame{stamp, cv::Mat(48, 64, CV_8UC1)};
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u)
      frame.gray.at<std::uint8_t>(v, u) =
          cv::saturate_cast<std::uint8_t>(gray + static_cast<int>(random.below(4)));
  return frame;
}

TEST(CameraWatch, finds_nothing_wrong_with_fresh_pictures) {
  CameraWatch watch;
  EXPECT_FALSE(watch.fault(noon)) << "no fault before the first frame";
  for (int i = 0; i < 20; ++i) {
    const Stamp now = noon + milliseconds(50) * i;
    EXPECT_FALSE(watch.update(frame_at(now - milliseconds(45), static_cast<std::uint64_t>(i)), now));
    EXPECT_FALSE(watch.fault(now));
  }
}

TEST(CameraWatch, misses_a_slow_camera_after_three_of_its_periods) {
  CameraWatch watch;
  Stamp now = noon;
  for (std::uint64_t i = 0; i < 5; ++i) {
    now += milliseconds(200);
    watch.update(frame_at(now, i), now);
    EXPECT_FALSE(i > 0 && watch.fault(now + milliseconds(190)));
  }
  EXPECT_FALSE(watch.fault(now + milliseconds(600)));
  EXPECT_EQ(watch.fault(now + milliseconds(601)), CameraFault::silent);
  now += seconds(30);
  watch.update(frame_at(now, 9), now);
  EXPECT_EQ(watch.fault(now + milliseconds(601)), CameraFault::silent)
      << "a pause does not count as a frame period";
}

TEST(CameraWatch, misses_a_camera_as_soon_as_before_after_one_short_interval) {
  CameraWatch watch;
  Stamp now = noon;
  for (std::uint64_t i = 0; i < 40; ++i) {
    now += i == 10 ? milliseconds(1) : milliseconds(50);
    watch.update(frame_at(now, i), now);
  }
  EXPECT_FALSE(watch.fault(now + milliseconds(150)));
  EXPECT_EQ(watch.fault(now + milliseconds(151)), CameraFault::silent);
}

TEST(CameraWatch, refuses_the_same_picture_again) {
  CameraWatch watch;
  watch.update(frame_at(noon, 1), noon);
  EXPECT_EQ(watch.update(frame_at(noon + milliseconds(50), 1), noon + milliseconds(60)),
            CameraFault::repeats);
  EXPECT_EQ(watch.fault(noon + milliseconds(60)), CameraFault::repeats);
  EXPECT_FALSE(watch.update(frame_at(noon + milliseconds(100), 2), noon + milliseconds(110)));
  EXPECT_FALSE(watch.fault(noon + milliseconds(110)));
}

TEST(CameraWatch, refuses_late_frames_and_those_of_another_clock) {
  CameraWatch watch;
  EXPECT_FALSE(watch.update(frame_at(noon - milliseconds(250), 1), noon));
  EXPECT_EQ(watch.update(frame_at(noon - milliseconds(251), 2), noon), CameraFault::late);
  EXPECT_EQ(watch.update(frame_at(noon + milliseconds(30), 3), noon), CameraFault::other_clock);
  EXPECT_EQ(watch.update(frame_at(noon - seconds(3600), 4), noon), CameraFault::other_clock);
}

TEST(CameraWatch, says_when_there_is_nothing_to_see) {
  CameraWatch watch;
  EXPECT_FALSE(watch.update(frame_at(noon, 1, 0), noon)) << "a dark frame is not refused";
  EXPECT_EQ(watch.fault(noon), CameraFault::dark);
  watch.update(frame_at(noon, 2, 255), noon);
  EXPECT_EQ(watch.fault(noon), CameraFault::bright);
  watch.update(frame_at(noon, 3), noon);
  EXPECT_FALSE(watch.fault(noon));
  EXPECT_EQ(watch.fault(noon + milliseconds(151)), CameraFault::silent);
}

TEST(CameraWatch, takes_frames_lost_now_and_then_for_no_silence) {
  CameraWatch watch;
  Random random(5);
  Stamp now = noon;
  Stamp arrived = noon;
  for (int i = 0; i < 20000; ++i, now += milliseconds(50)) {
    const bool is_learning = i < 200;
    if (!is_learning) {
      EXPECT_FALSE(watch.fault(now)) << i;
    }
    if (random.uniform() < 0.3) continue;
    watch.update(frame_at(now - milliseconds(45), static_cast<std::uint64_t>(i)), now);
    arrived = now;
  }
  EXPECT_EQ(watch.fault(arrived + milliseconds(501)), CameraFault::silent) << "half a second is too long";
}

}  // namespace
}  // namespace lodestar
