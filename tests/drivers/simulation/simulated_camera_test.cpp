#include "drivers/simulation/simulated_camera.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "drivers/simulation/tilt_wobble.hpp"
#include "maps/input_error.hpp"
#include "maps/paper_camera.hpp"

#include "tests/drivers/ceiling_pictures.hpp"

namespace lodestar {
namespace {

using std::chrono::milliseconds;
using testing::measure_spot;
using testing::one_marker;
using testing::plain_light;

Stamp at(Duration since_start) {
  return Stamp(since_start);
}

SimulatedCameraOptions steady_options() {
  SimulatedCameraOptions options = plain_light();
  options.lost_frame_probability = 0.0;
  options.tilt_sigma_rad = 0.0;
  return options;
}

/// A small image is enough where only stamps matter.
CameraModel tiny_camera() {
  return {32, 24, 30.0, 30.0, 15.5, 11.5, Distortion::none, {}};
}

SimulatedCamera tiny(const SimulatedCameraOptions& options, std::uint64_t seed = 1) {
  return {one_marker(0, {0.0, 0.0, 2.6}), tiny_camera(), Eigen::Isometry3d::Identity(), options, seed};
}

TEST(SimulatedCamera, stamps_mid_exposure_and_delivers_after_the_latency) {
  // GIVEN a frame every 50 ms, exposed for 4 ms, that arrives 45 ms after mid-exposure, and steps of 3 ms
  SimulatedCamera camera = tiny(steady_options());
  std::vector<Stamp> stamps;
  for (Duration now{0}; now <= milliseconds(300); now += milliseconds(3)) {
    camera.observe(at(now), {});
    while (const std::optional<Frame> frame = camera.poll()) {
      // THEN each comes at the first step at or after its arrival
      EXPECT_GE(at(now), frame->stamp + milliseconds(45));
      EXPECT_LT(at(now), frame->stamp + milliseconds(45 + 3));
      stamps.push_back(frame->stamp);
    }
  }
  // AND the stamps are the middles of exposures, one a period
  ASSERT_EQ(stamps.size(), 6U);
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    EXPECT_EQ(stamps[i], at(milliseconds(2 + 50 * static_cast<int>(i))));
  }
}

TEST(SimulatedCamera, frames_that_wait_come_in_order) {
  SimulatedCamera camera = tiny(steady_options());
  for (int ms = 0; ms <= 250; ms += 5) camera.observe(at(milliseconds(ms)), {});
  Stamp last = at(milliseconds(-1));
  int frames = 0;
  while (const std::optional<Frame> frame = camera.poll()) {
    EXPECT_GT(frame->stamp, last);
    last = frame->stamp;
    ++frames;
  }
  EXPECT_EQ(frames, 5);
}

TEST(SimulatedCamera, that_is_switched_on_late_begins_with_the_next_period) {
  SimulatedCamera camera = tiny(steady_options());
  for (int ms = 1020; ms <= 1110; ms += 5) camera.observe(at(milliseconds(ms)), {});
  const std::optional<Frame> frame = camera.poll();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->stamp, at(milliseconds(1052)));
  EXPECT_FALSE(camera.poll());
}

TEST(SimulatedCamera, loses_its_share_of_frames) {
  SimulatedCameraOptions options = steady_options();
  options.lost_frame_probability = 0.2;
  SimulatedCamera camera = tiny(options);
  constexpr int periods = 3000;
  int frames = 0;
  for (int i = 0; i < 10 * periods; ++i) {
    camera.observe(at(milliseconds(5 * i)), {});
    if (camera.poll()) ++frames;
  }
  const double sigma = std::sqrt(0.2 * 0.8 / periods);
  EXPECT_NEAR(1.0 - static_cast<double>(frames) / periods, 0.2, 4.0 * sigma);
}

TEST(SimulatedCamera, shows_the_true_pose_at_mid_exposure_between_two_steps) {
  // GIVEN a base that moves at 0.5 m/s, seen at steps of 5 ms, with the camera 0.2 m ahead and 0.3 m up
  const SimulatedCameraOptions options = steady_options();
  const CameraModel model = paper_camera();
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();
  base_from_camera.translation() << 0.2, 0.0, 0.3;
  SimulatedCamera camera(one_marker(0, {0.3, 0.0, 2.9}), model, base_from_camera, options, 1);
  const auto true_x_m = [](Stamp stamp) { return 0.5 * seconds(stamp); };
  int frames = 0;
  for (int ms = 0; ms <= 400; ms += 5) {
    camera.observe(at(milliseconds(ms)), {{true_x_m(at(milliseconds(ms))), 0.0}, 0.0});
    const std::optional<Frame> frame = camera.poll();
    if (!frame) continue;
    // THEN dot O is where the pose at the frame's stamp puts it
    const double offset_px = model.fx_px / 2.6 * (0.1 - true_x_m(frame->stamp));
    const Vec2 expected(model.cx_px + offset_px, model.cy_px);
    EXPECT_LT((measure_spot(frame->gray, expected, 9, options.background_gray).center_px - expected).norm(),
              0.02);
    ++frames;
  }
  EXPECT_EQ(frames, 8);
}

TEST(SimulatedCamera, same_seed_gives_the_same_frames) {
  SimulatedCameraOptions options;
  options.lost_frame_probability = 0.3;
  SimulatedCamera one = tiny(options, 5);
  SimulatedCamera same = tiny(options, 5);
  int frames = 0;
  for (int ms = 0; ms <= 1000; ms += 5) {
    one.observe(at(milliseconds(ms)), {{0.001 * ms, 0.0}, 0.0});
    same.observe(at(milliseconds(ms)), {{0.001 * ms, 0.0}, 0.0});
    const std::optional<Frame> a = one.poll();
    const std::optional<Frame> b = same.poll();
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    ++frames;
    EXPECT_EQ(a->stamp, b->stamp);
    EXPECT_EQ(cv::countNonZero(a->gray != b->gray), 0);
  }
  EXPECT_GT(frames, 5);
}

TEST(SimulatedCamera, refuses_times_that_cannot_be) {
  SimulatedCameraOptions too_long = steady_options();
  too_long.exposure = too_long.period;
  EXPECT_THROW(tiny(too_long), InputError);
  SimulatedCameraOptions too_early = steady_options();
  too_early.latency = milliseconds(1);
  EXPECT_THROW(tiny(too_early), InputError);
  SimulatedCameraOptions no_share = steady_options();
  no_share.lost_frame_probability = 1.5;
  EXPECT_THROW(tiny(no_share), InputError);
}

TEST(TiltWobble, is_smooth_and_has_the_deviation_asked_for) {
  const TiltWobble wobble(0.002, Random(3));
  double sum = 0.0;
  double squares = 0.0;
  double largest_step = 0.0;
  constexpr int count = 200000;
  double last = angles_of(wobble.at(at(milliseconds(0))).linear()).roll_rad;
  for (int i = 0; i < count; ++i) {
    const double roll = angles_of(wobble.at(at(milliseconds(10 * i))).linear()).roll_rad;
    sum += roll;
    squares += roll * roll;
    largest_step = std::max(largest_step, std::abs(roll - last));
    last = roll;
  }
  EXPECT_NEAR(sum / count, 0.0, 0.0001);
  EXPECT_NEAR(std::sqrt(squares / count), 0.002, 0.0001);
  EXPECT_LT(largest_step, 0.001);
}

TEST(TiltWobble, turns_about_the_floor_point) {
  EXPECT_EQ(TiltWobble(0.01, Random(3)).at(at(milliseconds(77))).translation(), Vec3::Zero());
}

}  // namespace
}  // namespace lodestar
