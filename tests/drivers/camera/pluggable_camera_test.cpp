#include "drivers/camera/pluggable_camera.hpp"

#include <condition_variable>
#include <gtest/gtest.h>
#include <mutex>
#include <thread>

#include "maps/input_error.hpp"

#include "tests/drivers/video_device_stand_in.hpp"

namespace lodestar {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::size_t whole_picture = 32;

/// Simulates plugging a camera in and out, on the test's own clock. Waits for work on other threads, however
/// busy the machine is.
class PluggableCameraTest : public testing::Test {
 protected:
  std::unique_ptr<V4l2Camera> open() {
    std::unique_lock lock(mutex);
    ++opened;
    // Held until the thread ends: only then can the camera take the attempt's result.
    if (std::this_thread::get_id() != of_test) std::notify_all_at_thread_exit(ended, std::move(lock));
    return std::make_unique<V4l2Camera>(std::make_unique<VideoDeviceStandIn>(script), "/dev/video7", options);
  }

  /// Waits until this attempt to open the camera has ended.
  bool attempt_is_over(int number) {
    std::unique_lock lock(mutex);
    return ended.wait_for(lock, std::chrono::minutes(1), [&] { return opened >= number; });
  }

  /// Expects no frame and, within 20 ms, no attempt to open the camera.
  void expect_patience(PluggableCamera& camera) {
    const int before = attempts();
    EXPECT_FALSE(camera.poll());
    std::this_thread::sleep_for(milliseconds(20));
    EXPECT_EQ(attempts(), before);
  }

  int attempts() {
    const std::lock_guard lock(mutex);
    return opened;
  }

  PluggableCamera camera() {
    return PluggableCamera([this] { return open(); }, {.now = [this] { return now; }});
  }

  void take_picture() { script.captures.push_back({.bytes = std::vector<std::uint8_t>(whole_picture, 9)}); }

  VideoScript script;
  V4l2CameraOptions options;
  Stamp now{seconds(1)};

 private:
  const std::thread::id of_test = std::this_thread::get_id();
  std::mutex mutex;
  std::condition_variable ended;
  int opened = 0;
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
  now += milliseconds(999);
  expect_patience(camera);

  script.unplugged = false;
  take_picture();
  now += milliseconds(1);
  EXPECT_FALSE(camera.poll());
  ASSERT_TRUE(attempt_is_over(2));
  EXPECT_TRUE(camera.poll());
  EXPECT_EQ(attempts(), 2);
}

TEST_F(PluggableCameraTest, has_its_settings_again_after_it_was_unplugged) {
  script.exposure_100us = 300;
  options.exposure = milliseconds(2);
  PluggableCamera camera = this->camera();
  ASSERT_EQ(script.exposure_100us, 20);
  script.unplugged = true;
  EXPECT_FALSE(camera.poll());
  script.exposure_100us = 300;  // as it is when it has just got power
  script.unplugged = false;
  now += seconds(1);
  EXPECT_FALSE(camera.poll());
  ASSERT_TRUE(attempt_is_over(2));
  EXPECT_EQ(script.exposure_100us, 20);
}

TEST_F(PluggableCameraTest, is_tried_again_every_second_for_as_long_as_it_takes) {
  PluggableCamera camera = this->camera();
  script.unplugged = true;
  for (int attempt = 2; attempt <= 4; ++attempt) {
    now += milliseconds(999);
    expect_patience(camera);
    now += milliseconds(1);
    EXPECT_FALSE(camera.poll());
    ASSERT_TRUE(attempt_is_over(attempt));
    expect_patience(camera);
  }
  script.unplugged = false;
  take_picture();
  now += seconds(1);
  EXPECT_FALSE(camera.poll());
  ASSERT_TRUE(attempt_is_over(5));
  EXPECT_TRUE(camera.poll());
  EXPECT_EQ(attempts(), 5);
}

TEST_F(PluggableCameraTest, that_hangs_is_opened_anew) {
  PluggableCamera camera = this->camera();
  take_picture();
  ASSERT_TRUE(camera.poll());
  now += milliseconds(1999);
  expect_patience(camera);
  now += milliseconds(1);
  EXPECT_FALSE(camera.poll());
  ASSERT_TRUE(attempt_is_over(2));
  take_picture();
  EXPECT_TRUE(camera.poll());
  EXPECT_EQ(attempts(), 2);
}

}  // namespace
}  // namespace lodestar
