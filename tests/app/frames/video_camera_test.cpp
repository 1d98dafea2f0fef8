#include "app/frames/video_camera.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "maps/input_error.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A video of 20 frames a second, opened two seconds after the robot's time began.
class VideoCameraTest : public testing::Test {
 protected:
  void SetUp() override {
    const std::string file = (folder / "drive.avi").string();
    cv::VideoWriter writer(file, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 20.0, {64, 48}, false);
    ASSERT_TRUE(writer.isOpened()) << "OpenCV always has its own MJPEG writer";
    for (int i = 0; i < 5; ++i) writer.write(cv::Mat(48, 64, CV_8UC1, cv::Scalar(40 * i)));
  }

  int frames_now(VideoCamera& camera) {
    int count = 0;
    for (; const auto frame = camera.poll(); ++count) {
      EXPECT_LE(frame->stamp, now);
      EXPECT_GT(frame->stamp, now - milliseconds(51)) << "at most one frame period old";
      EXPECT_EQ(frame->gray.type(), CV_8UC1);
    }
    return count;
  }

  TemporaryFolder folder;
  Stamp now{seconds(2)};
};

TEST_F(VideoCameraTest, plays_in_real_time_from_the_first_poll_on) {
  VideoCamera camera(folder / "drive.avi", [this] { return now; });
  now += seconds(3);  // the robot was not ready yet
  EXPECT_EQ(frames_now(camera), 1);
  EXPECT_EQ(frames_now(camera), 0) << "the next frame is not due yet";
  now += milliseconds(49);
  EXPECT_EQ(frames_now(camera), 0);
  now += milliseconds(2);
  EXPECT_EQ(frames_now(camera), 1);
}

TEST_F(VideoCameraTest, falls_silent_at_its_end) {
  VideoCamera camera(folder / "drive.avi", [this] { return now; });
  int frames = 0;
  for (int i = 0; i < 20; ++i, now += milliseconds(50)) frames += frames_now(camera);
  EXPECT_EQ(frames, 5);
  now += seconds(100);
  EXPECT_EQ(frames_now(camera), 0);
}

TEST_F(VideoCameraTest, refuses_what_is_no_video) {
  EXPECT_THROW(VideoCamera(folder / "nothing.avi"), InputError);
}

}  // namespace
}  // namespace lodestar
