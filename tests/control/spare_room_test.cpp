#include "control/spare_room.hpp"

#include <gtest/gtest.h>

#include "maps/geometry.hpp"

namespace lodestar {
namespace {

Eigen::Matrix3d covariance(double larger_sigma_m, double yaw_sigma_rad) {
  const Vec3 sigmas(0.5 * larger_sigma_m, larger_sigma_m, yaw_sigma_rad);
  return Eigen::Matrix3d(sigmas.array().square().matrix().asDiagonal());
}

TEST(SpareRoom, is_none_for_a_robot_as_sure_as_usual) {
  const SpareRoom spare = room_for_doubt(covariance(0.004, radians(5.0)));
  EXPECT_EQ(spare.here_m, 0.0);
  EXPECT_EQ(spare.per_m, 0.0);
}

TEST(SpareRoom, grows_with_the_larger_deviation_and_on_the_way_with_that_of_the_heading) {
  const SpareRoom spare = room_for_doubt(covariance(0.04, radians(2.0)));
  EXPECT_NEAR(spare.here_m, 0.105, 1e-9);
  EXPECT_NEAR(spare.per_m, 3.0 * radians(2.0), 1e-9);
}

}  // namespace
}  // namespace lodestar
