#include "drivers/camera/pluggable_camera.hpp"

#include <atomic>
#include <gtest/gtest.h>
#include <thread>

#include "maps/input_error.hpp"

#include "tests/drivers/video_device_stand_in.hpp"

namespace lodestar {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::size_t whole_picture = 32;

/// Somebody plugs a camera in and out; the time is the test's.
class PluggableCameraTest : public testing::Test {
 protected:
  std::unique_ptr<V4l2Camera> open() {
    ++opened;
    return std::make_unique<V4l2Camera>(std::make_unique<VideoDeviceStandIn>(script), "/dev/video7",
                                        V4l2CameraOptions{});
  }

  PluggableCamera camera() {
    return PluggableCamera([this] { return open(); }, {.now = [this] { return now; }});
  }

  void take_picture() { script.captures.push_back({.bytes = std::vector<std::uint8_t>(whole_picture, 9)}); }

  /// Polls until a frame comes; what is done on the side takes its time.
  static bool gives_a_frame(PluggableCamera& camera) {
    for (int tries = 0; tries < 2000; ++tries) {
      if (camera.poll()) return true;
      std::this_thread::sleep_for(milliseconds(1));
    }
    return false;
  }

  VideoScript script;
  Stamp now{seconds(1)};
  std::atomic<int> opened = 0;  // by another thread
};

TEST_F(PluggableCameraTest, is_refused_when_it_is_not_there_at_the_start) {
  script.unplugged = true;
  EXPECT_THROW(camera(), InputError);
}

TEST_F(PluggableCameraTest, comes_back_by_itself_after_it_was_unplugged) {
  PluggableCamera camera = this->camera();
  take_picture();
  ASSERT_TRUE(camera.poll());

  script.unplugged = true;
  EXPECT_FALSE(camera.poll());
  now += milliseconds(500);
  EXPECT_FALSE(camera.poll());
  EXPECT_EQ(opened, 1) << "no attempt before a second is over";

  script.unplugged = false;
  take_picture();
  now += milliseconds(500);
  EXPECT_TRUE(gives_a_frame(camera));
  EXPECT_EQ(opened, 2);
}

TEST_F(PluggableCameraTest, is_tried_again_every_second_for_as_long_as_it_takes) {
  PluggableCamera camera = this->camera();
  script.unplugged = true;
  for (int second = 0; second < 3; ++second) {
    now += seconds(1);
    const int before = opened;
    for (int tries = 0; tries < 50 && opened == before; ++tries) {
      EXPECT_FALSE(camera.poll());
      std::this_thread::sleep_for(milliseconds(1));
    }
    for (int tries = 0; tries < 50; ++tries) {
      EXPECT_FALSE(camera.poll());
      std::this_thread::sleep_for(milliseconds(1));
    }
    EXPECT_EQ(opened, before + 1);
  }
  script.unplugged = false;
  take_picture();
  now += seconds(1);
  EXPECT_TRUE(gives_a_frame(camera));
}

TEST_F(PluggableCameraTest, that_hangs_is_opened_anew) {
  PluggableCamera camera = this->camera();
  take_picture();
  ASSERT_TRUE(camera.poll());
  now += milliseconds(1900);
  EXPECT_FALSE(camera.poll());
  EXPECT_EQ(opened, 1);
  now += milliseconds(200);
  EXPECT_FALSE(camera.poll());
  take_picture();
  EXPECT_TRUE(gives_a_frame(camera));
  EXPECT_EQ(opened, 2);
}

}  // namespace
}  // namespace lodestar
