#include "localization/pose/mount.hpp"

#include <gtest/gtest.h>

#include "maps/random.hpp"

namespace lodestar {
namespace {

PoseFix fix_at(const Eigen::Isometry3d& map_from_camera) {
  PoseFix fix;
  fix.map_from_camera = map_from_camera;
  fix.covariance = 1e-6 * Eigen::Matrix<double, 6, 6>::Identity();
  return fix;
}

TEST(Mount, is_equation_17_for_a_camera_straight_ahead) {
  const double r = 0.15;
  const double theta = 0.8;
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();
  base_from_camera.translation().x() = r;
  const PlanarFix fix = compensate_mount(fix_at(lifted({{2.0, 3.0}, theta}, 1.1)), base_from_camera);
  EXPECT_NEAR(fix.map_from_base.position_m.x(), 2.0 - r * std::cos(theta), 1e-12);
  EXPECT_NEAR(fix.map_from_base.position_m.y(), 3.0 - r * std::sin(theta), 1e-12);
  EXPECT_NEAR(fix.map_from_base.yaw_rad, theta, 1e-12);
}

TEST(Mount, undoes_any_mount) {
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();
  base_from_camera.linear() = rotation_from({radians(0.5), radians(-0.7), radians(90.0)});
  base_from_camera.translation() << -0.1, 0.02, 1.1;
  const Pose2 truth{{4.0, 1.0}, -2.0};
  const PlanarFix fix = compensate_mount(fix_at(lifted(truth) * base_from_camera), base_from_camera);
  EXPECT_LT((fix.map_from_base.position_m - truth.position_m).norm(), 1e-12);
  EXPECT_NEAR(fix.map_from_base.yaw_rad, truth.yaw_rad, 1e-12);
}

TEST(Mount, carries_the_covariance_along_the_lever) {
  // A tilt of the camera moves the base far below it; checked against finite differences.
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();
  base_from_camera.linear() = rotation_from({radians(2.0), radians(-3.0), radians(40.0)});
  base_from_camera.translation() << -0.1, 0.02, 1.1;
  const Eigen::Isometry3d view = lifted({{4.0, 1.0}, -2.0}) * base_from_camera;
  for (int axis = 0; axis < 6; ++axis) {
    constexpr double step = 1e-5;
    Eigen::Isometry3d moved = view;
    if (axis < 3) {
      moved.translation()[axis] += step;
    } else {
      moved.linear() = Eigen::AngleAxisd(step, Vec3::Unit(axis - 3)).toRotationMatrix() * view.linear();
    }
    PoseFix fix = fix_at(view);
    fix.covariance.setZero();
    fix.covariance(axis, axis) = step * step;
    const PlanarFix before = compensate_mount(fix, base_from_camera);
    const PlanarFix after = compensate_mount(fix_at(moved), base_from_camera);
    Vec3 change;
    change << after.map_from_base.position_m - before.map_from_base.position_m,
        wrap_angle(after.map_from_base.yaw_rad - before.map_from_base.yaw_rad);
    EXPECT_LT((change * change.transpose() - before.covariance).cwiseAbs().maxCoeff(), 1e-3 * step * step)
        << "axis " << axis;
  }
}

TEST(FitCircle, finds_the_circle_of_a_spinning_robot) {
  Random random(1);
  std::vector<Vec2> points;
  for (int i = 0; i < 500; ++i) {
    const double angle = 0.02 * std::numbers::pi * i;  // five turns
    points.push_back(Vec2(1.0 + 0.12 * std::cos(angle), 2.0 + 0.12 * std::sin(angle)) +
                     0.005 * Vec2(random.normal(), random.normal()));
  }
  const auto circle = fit_circle(points);
  ASSERT_TRUE(circle.has_value());
  EXPECT_NEAR(circle->radius_m, 0.12, 0.001);
  EXPECT_LT((circle->center_m - Vec2(1.0, 2.0)).norm(), 0.001);
}

TEST(FitCircle, has_none_for_too_few_points_or_a_line) {
  EXPECT_FALSE(fit_circle({Vec2(0, 0), Vec2(1, 0)}));
  EXPECT_FALSE(fit_circle({Vec2(0, 0), Vec2(1, 0), Vec2(2, 0), Vec2(3, 0)}));
}

}  // namespace
}  // namespace lodestar
