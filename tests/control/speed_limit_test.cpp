#include "control/speed_limit.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "tests/maps/empty_floor.hpp"

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

TEST(SpeedLimit, is_low_in_a_gap_so_that_a_slipping_wheel_cannot_lead_into_its_side) {
  const auto speed_mps = [](double gap_m, const CautionOptions& caution = {}) {
    OccupancyMap map = empty_floor(120, 80, 0.05);  // walls at x = 3 with a gap at y = 2
    const int open = static_cast<int>(std::lround(gap_m / map.resolution_m));
    for (int row = 0; row < map.rows; ++row)
      if (row < 40 - open / 2 || row >= 40 - open / 2 + open)
        for (int column = 60; column < 64; ++column)
          map.cells[map.index({column, row})] = OccupancyMap::occupied;
    const PoseEstimate sure{.map_from_base = {{2.85, 2.0}, 0.0},
                            .covariance = 1e-6 * Eigen::Matrix3d::Identity()};
    return safe_speed(ForwardClearance(std::make_shared<const ObstacleField>(map), 0.25), sure, {},
                      {.caution = caution})
        .forward_mps;
  };
  EXPECT_NEAR(speed_mps(2.0), DriveOptions{}.max_forward_mps, 1e-9);
  EXPECT_GT(speed_mps(0.9), 0.45);
  EXPECT_LT(speed_mps(0.6), 0.4);
  EXPECT_GE(speed_mps(0.5), CautionOptions{}.creep_mps);
  EXPECT_LT(speed_mps(0.5), 0.2);
  const CautionOptions contradicted{.swing_per_m = CautionOptions{}.contradicted_swing_per_m};
  EXPECT_NEAR(speed_mps(2.0, contradicted), DriveOptions{}.max_forward_mps, 1e-9);
  EXPECT_LT(speed_mps(0.7, contradicted), 0.5 * speed_mps(0.7));
}

}  // namespace
}  // namespace lodestar
