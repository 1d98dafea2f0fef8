#include "localization/pose/second_order_covariance.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "maps/random.hpp"

namespace lodestar {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

const Vec3 center_from_camera(0.3, -0.2, 2.6);

/// Covariance of a camera that knows the dots' centre in its own frame much better than its tilt.
Mat6 linear_covariance() {
  const Vec3 center_sigma_m(0.004, 0.003, 0.02);
  const Vec3 turn_sigma(0.03, 0.05, 0.01);
  Eigen::Matrix3d swing;  // -theta x u
  swing << 0.0, -center_from_camera.z(), center_from_camera.y(), center_from_camera.z(), 0.0,
      -center_from_camera.x(), -center_from_camera.y(), center_from_camera.x(), 0.0;
  Mat6 by_causes = Mat6::Identity();
  by_causes.topRightCorner<3, 3>() = swing;
  Vec6 variances;
  variances << center_sigma_m.array().square(), turn_sigma.array().square();
  return by_causes * variances.asDiagonal() * by_causes.transpose();
}

/// True motion of the camera for these errors of the linear model: the dots stay, and the camera's offset
/// from them turns with it.
Vec3 moved(const Vec6& linear) {
  const Vec3 turn = linear.tail<3>();
  const Vec3 off = -linear.head<3>() - turn.cross(center_from_camera);
  const Eigen::AngleAxisd rotation(turn.norm(), turn.normalized());
  return center_from_camera - rotation * (center_from_camera + off);
}

TEST(PlaceCovariance, has_what_the_linear_view_leaves_out_where_the_tilt_is_in_doubt) {
  Random random(1);
  const Mat6 covariance = linear_covariance();
  const Mat6 factor = covariance.llt().matrixL();
  Eigen::Matrix3d left_out = Eigen::Matrix3d::Zero();
  constexpr int count = 200'000;
  for (int i = 0; i < count; ++i) {
    Vec6 numbers;
    for (double& number : numbers) number = random.normal();
    const Vec6 linear = factor * numbers;
    const Vec3 beyond = moved(linear) - linear.head<3>();
    left_out += beyond * beyond.transpose() / count;
  }
  const Eigen::Matrix3d stated = arc_covariance(center_from_camera, covariance);
  EXPECT_LT((stated - left_out).norm(), 0.03 * left_out.norm()) << stated << "\n\n" << left_out;
  EXPECT_NEAR(stated(0, 0) / left_out(0, 0), 1.0, 0.05);
  EXPECT_NEAR(stated(1, 1) / left_out(1, 1), 1.0, 0.05);
}

TEST(PlaceCovariance, leaves_out_nothing_where_the_rotation_is_known) {
  Mat6 covariance = Mat6::Zero();
  covariance.diagonal().head<3>() << 1e-4, 2e-4, 3e-4;
  EXPECT_EQ(arc_covariance(center_from_camera, covariance), Eigen::Matrix3d::Zero());
}

TEST(PlaceCovariance, of_a_scale_lies_along_the_optical_axis_and_grows_with_the_distance) {
  const Vec3 axis = Vec3(0.1, 0.0, 1.0).normalized();
  const double depth_m = axis.dot(center_from_camera);
  const Eigen::Matrix3d stated = scale_covariance(center_from_camera, axis, 1e-3);
  EXPECT_NEAR(axis.dot(stated * axis), 1e-6 * depth_m * depth_m, 1e-15);
  EXPECT_NEAR(stated.trace(), 1e-6 * depth_m * depth_m, 1e-15);
}

}  // namespace
}  // namespace lodestar
