#include "drivers/camera/genicam_camera.hpp"

#include <arv.h>
#include <cmath>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <thread>
#include <unistd.h>

#include "drivers/camera/pluggable_camera.hpp"
#include "maps/input_error.hpp"
#include "maps/median.hpp"

namespace lodestar {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

const std::string address = "127.0.0.1";

/// A GigE Vision camera by Aravis, that speaks over the loopback interface.
class GigECamera {
 public:
  /// Waits for other tests that use the port of this protocol, which is one for all.
  GigECamera() : lock_(open("/tmp/lodestar-gige-vision.lock", O_CREAT | O_RDWR | O_CLOEXEC, 0666)) {
    flock(lock_, LOCK_EX);
    plug_in();
  }
  ~GigECamera() {
    unplug();
    close(lock_);
  }
  GigECamera(const GigECamera&) = delete;
  GigECamera& operator=(const GigECamera&) = delete;

  void plug_in() { camera_ = arv_gv_fake_camera_new_full(address.c_str(), "LS001", nullptr); }
  void unplug() {
    if (camera_ != nullptr) g_object_unref(camera_);
    camera_ = nullptr;
  }
  [[nodiscard]] bool runs() const { return camera_ != nullptr && arv_gv_fake_camera_is_running(camera_); }

 private:
  int lock_;
  ArvGvFakeCamera* camera_ = nullptr;
};

const GenicamCameraOptions vga{.width_px = 640, .height_px = 480, .exposure = 4ms, .rate_hz = 50.0};

std::optional<Frame> next_frame(Camera& camera, Duration at_most = 10s) {
  const Stamp end = monotonic_now() + at_most;
  while (monotonic_now() < end) {
    if (std::optional<Frame> frame = camera.poll()) return frame;
    std::this_thread::sleep_for(1ms);
  }
  return std::nullopt;
}

std::string refusal(const std::string& id, const GenicamCameraOptions& options) {
  try {
    const GenicamCamera camera(id, options);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

class GenicamCameraTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!device.runs()) GTEST_SKIP() << "no port 3956 on the loopback interface";
  }

  GigECamera device;
};

TEST_F(GenicamCameraTest, streams_frames_of_the_calibrated_size_with_regular_stamps) {
  GenicamCamera camera(address, vga);
  std::vector<Stamp> stamps;
  for (int i = 0; i < 60; ++i) {
    const std::optional<Frame> frame = next_frame(camera);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->gray.size(), cv::Size(640, 480));
    EXPECT_EQ(frame->gray.type(), CV_8UC1);
    EXPECT_LE(frame->stamp, monotonic_now() - 2ms) << "the middle of an exposure of 4 ms";
    stamps.push_back(frame->stamp);
  }
  // From the first frames, which may be held up, the camera's clock is learned.
  for (std::size_t i = 10; i < stamps.size(); ++i) EXPECT_GT(stamps[i], stamps[i - 1]);
  // The median, as a busy machine may hold the camera itself up for more than a period.
  std::vector<double> periods_ms;
  for (std::size_t i = 1; i < stamps.size(); ++i)
    periods_ms.push_back(std::chrono::duration<double, std::milli>(stamps[i] - stamps[i - 1]).count());
  EXPECT_NEAR(median(periods_ms), 20.0, 2.0);
  EXPECT_THAT(camera.description(),
              HasSubstr("50 frames a second, exposure 4.0 ms, stamped by its own clock"));
}

TEST_F(GenicamCameraTest, keeps_what_it_is_set_to_where_nothing_is_asked) {
  GenicamCamera camera(address, {});
  const std::optional<Frame> frame = next_frame(camera);
  ASSERT_TRUE(frame);
  EXPECT_GT(frame->gray.cols, 0);
}

TEST_F(GenicamCameraTest, refuses_what_it_does_not_deliver) {
  EXPECT_THAT(refusal(address, {.width_px = 64'000, .height_px = 480}),
              HasSubstr("wanted 64000 x 480, as its calibration"));
  EXPECT_THAT(refusal(address, {.exposure = std::chrono::hours(1)}),
              HasSubstr("no exposure that can be set"));
  EXPECT_THAT(refusal("127.0.0.2", vga), HasSubstr("genicam:127.0.0.2: found no such camera"));
}

TEST_F(GenicamCameraTest, is_lost_when_it_is_unplugged_and_comes_back) {
  std::unique_ptr<Camera> camera = open_genicam_camera(address, vga);
  ASSERT_TRUE(next_frame(*camera));
  device.unplug();
  const Stamp end = monotonic_now() + 10s;
  while (monotonic_now() < end && next_frame(*camera, 200ms)) {
  }
  device.plug_in();
  ASSERT_TRUE(device.runs());
  EXPECT_TRUE(next_frame(*camera, 30s));
}

}  // namespace
}  // namespace lodestar
