#include "drivers/simulation/simulated_motion.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "tests/drivers/perfect_base.hpp"

// The wheels and the floor alone, without bus and driver.
namespace lodestar {
namespace {

using std::chrono::milliseconds;

TEST(SimulatedBase, follows_the_exact_arc) {
  SimulatedBaseOptions options = perfect_base();
  options.motor_lag_s = 0.0;
  options.max_wheel_acceleration_mps2 = 1e9;
  const double radius_m = 0.5 / 0.8;
  SimulatedMotion motion(options, {}, 1);
  motion.set_wheel_targets(0.5 - 0.8 * 0.2, 0.5 + 0.8 * 0.2);
  motion.step(milliseconds(1));
  const Pose2 start = motion.true_map_from_base();
  const Vec2 centre = start * Vec2(0.0, radius_m);
  for (int i = 0; i < 5000; ++i) {
    motion.step(milliseconds(1));
    ASSERT_NEAR((motion.true_map_from_base().position_m - centre).norm(), radius_m, 1e-9);
  }
  EXPECT_NEAR(wrap_angle(motion.true_map_from_base().yaw_rad - start.yaw_rad - 0.8 * 5.0), 0.0, 1e-9);
}

TEST(SimulatedBase, never_accelerates_beyond_what_its_motors_can) {
  const SimulatedBaseOptions options = perfect_base();
  SimulatedMotion motion(options, {}, 1);
  motion.set_wheel_targets(1.0, 1.0);
  double speed_mps = 0.0;
  double x_m = 0.0;
  for (int i = 0; i < 2000; ++i) {
    motion.step(milliseconds(1));
    const double now_mps = (motion.true_map_from_base().position_m.x() - x_m) / 0.001;
    x_m = motion.true_map_from_base().position_m.x();
    EXPECT_LE(now_mps - speed_mps, options.max_wheel_acceleration_mps2 * 0.001 + 1e-9);
    speed_mps = now_mps;
  }
  EXPECT_NEAR(speed_mps, 1.0, 1e-3);
}

TEST(SimulatedBase, brakes_as_hard_as_a_protective_stop_wants) {
  SimulatedMotion motion(perfect_base(), {}, 1);
  motion.set_wheel_targets(0.6, 0.6);
  for (int i = 0; i < 2000; ++i) motion.step(milliseconds(1));
  const double begins_m = motion.true_map_from_base().position_m.x();
  motion.set_wheel_targets(0.0, 0.0);
  for (int i = 0; i < 2000; ++i) motion.step(milliseconds(1));
  const double needed_m = motion.true_map_from_base().position_m.x() - begins_m;
  EXPECT_LT(needed_m, square(0.6) / (2.0 * 1.5)) << "1.5 m/s^2, with the lag of the motors";
  EXPECT_GT(needed_m, square(0.6) / (2.0 * 2.0)) << "not better than the motors can";
}

TEST(SimulatedBase, slips_with_the_square_root_of_the_way_whatever_the_step) {
  SimulatedBaseOptions options = perfect_base();
  options.slip_sigma_per_sqrt_m = 0.002;
  for (const int step_ms : {1, 4}) {
    double squares = 0.0;
    constexpr int runs = 200;
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
      SimulatedMotion motion(options, {}, seed);
      motion.set_wheel_targets(1.0, 1.0);
      for (int ms = 0; ms < 4000; ms += step_ms) motion.step(milliseconds(step_ms));
      const double turned_m = motion.true_map_from_base().yaw_rad * options.true_track_width_m;
      squares += turned_m * turned_m / (motion.left_encoder_m() + motion.right_encoder_m());
    }
    // The slip of each wheel has a sigma of 2 mm after a metre; 200 runs estimate it to 5 %.
    EXPECT_NEAR(std::sqrt(squares / runs), 0.002, 4 * 0.0001) << "at a step of " << step_ms << " ms";
  }
}

TEST(SimulatedBase, counts_its_wheels_in_encoder_steps) {
  SimulatedBaseOptions options = perfect_base();
  options.encoder_step_m = 0.01;
  SimulatedMotion motion(options, {}, 1);
  motion.set_wheel_targets(0.3, -0.3);
  for (int i = 0; i < 500; ++i) {
    motion.step(milliseconds(1));
    const double steps = motion.left_encoder_m() / 0.01;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    EXPECT_LE(motion.left_encoder_m(), motion.true_map_from_base().position_m.norm() + 1.0);
  }
  EXPECT_GT(motion.left_encoder_m(), 0.08);
  EXPECT_LT(motion.right_encoder_m(), -0.08);
}

}  // namespace
}  // namespace lodestar
