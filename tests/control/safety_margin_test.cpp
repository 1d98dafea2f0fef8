#include "control/safety_margin.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "control/forward_clearance.hpp"
#include "maps/geometry.hpp"

namespace lodestar {
namespace {

Eigen::Matrix3d covariance(double larger_sigma_m, double yaw_sigma_rad) {
  const Vec3 sigmas(0.5 * larger_sigma_m, larger_sigma_m, yaw_sigma_rad);
  return Eigen::Matrix3d(sigmas.array().square().matrix().asDiagonal());
}

TEST(SafetyMargin, is_none_for_a_robot_as_sure_as_usual) {
  const SafetyMargin spare = margin_for_uncertainty(covariance(0.004, radians(5.0)));
  EXPECT_EQ(spare.here_m, 0.0);
  EXPECT_EQ(spare.per_m, 0.0);
}

TEST(SafetyMargin, grows_with_the_larger_deviation_and_on_the_way_with_that_of_the_heading) {
  const SafetyMargin spare = margin_for_uncertainty(covariance(0.04, radians(2.0)));
  EXPECT_NEAR(spare.here_m,
              ForwardClearance::usual_tolerance_m + 2.3 * std::sqrt(0.04 * 0.04 - 0.005 * 0.005), 1e-9);
  EXPECT_NEAR(spare.per_m, 2.3 * radians(2.0), 1e-9);
}

TEST(SafetyMargin, does_not_jump_where_it_begins) {
  EXPECT_NEAR(margin_for_uncertainty(covariance(0.005, 0.0)).here_m, 0.0, 1e-9);
  EXPECT_LT(margin_for_uncertainty(covariance(0.0051, 0.0)).here_m, 0.004);
}

TEST(SafetyMargin, is_less_on_the_way_back) {
  const Eigen::Matrix3d lost = covariance(0.08, radians(2.0));
  EXPECT_LT(margin_on_the_way_back(lost).here_m, margin_for_uncertainty(lost).here_m);
  EXPECT_NEAR(margin_on_the_way_back(lost).here_m,
              ForwardClearance::usual_tolerance_m + 2.0 * std::sqrt(0.08 * 0.08 - 0.005 * 0.005), 1e-9);
  EXPECT_EQ(margin_on_the_way_back(lost).per_m, 0.0);
}

}  // namespace
}  // namespace lodestar
