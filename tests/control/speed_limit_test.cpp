#include "control/speed_limit.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

TEST(SpeedLimit, leaves_the_way_that_latency_and_braking_take) {
  for (const double distance_m : {0.0, 0.01, 0.1, 0.5, 3.0}) {
    const double speed = speed_to_stop_within(distance_m, 0.4, 0.12);
    EXPECT_NEAR(0.12 * speed + speed * speed / (2.0 * 0.4), distance_m, 1e-12);
  }
  EXPECT_EQ(speed_to_stop_within(-1.0, 0.4, 0.12), 0.0);
}

TEST(SpeedLimit, goes_at_full_speed_while_sure_and_slower_without_a_jump_up_to_the_limit) {
  const SafetyStopOptions limits;
  const CautionOptions options;
  const auto share = [&](double position_sigma_m, double heading_sigma_rad) {
    const Eigen::Vector3d sigmas(position_sigma_m, 0.001, heading_sigma_rad);
    return share_of_speed(sigmas.cwiseAbs2().asDiagonal(), limits, options);
  };
  EXPECT_EQ(share(0.005, 0.001), 1.0);
  EXPECT_NEAR(share(limits.max_position_sigma_m, 0.001), options.slowest, 1e-12);
  EXPECT_NEAR(share(0.005, limits.max_heading_sigma_rad), options.slowest, 1e-12);
  double last = 1.0;
  for (int i = 0; i <= 1000; ++i) {
    const double now = share(0.001 * 0.06 * i, 0.0);
    EXPECT_LE(now, last);
    EXPECT_GT(now, last - 0.01);
    last = now;
  }
}

}  // namespace
}  // namespace lodestar
