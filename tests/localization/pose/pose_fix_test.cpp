#include "localization/pose/pose_fix.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>

#include "localization/pose/map_estimate.hpp"
#include "maps/paper_camera.hpp"
#include "maps/random.hpp"

#include "tests/localization/pose/fix_cameras.hpp"
#include "tests/localization/seen_markers.hpp"

namespace lodestar {
namespace {

using namespace testing;

TEST(FixPose, without_noise_is_the_truth_in_every_mode) {
  Random random(1);
  const MarkerRegistry registry = ceiling();
  for (const CameraModel& camera : {paper_camera(), wide_camera()}) {
    for (const auto& tilt_sigma :
         {std::optional<double>(), std::optional(0.0), std::optional(radians(0.1))}) {
      for (int i = 0; i < 50; ++i) {
        const Eigen::Isometry3d view =
            view_from({random.uniform(0.9, 1.5), random.uniform(1.7, 2.1), random.uniform(0.2, 1.0)},
                      random.uniform(-3.1, 3.1));
        const auto fix = fix_pose(Stamp{}, seen(view, registry, camera, 0.0, random), registry, camera,
                                  with_tilt_sigma(tilt_sigma, 0.1));
        ASSERT_TRUE(fix.has_value());
        EXPECT_LT(error_of(*fix, view).cwiseAbs().maxCoeff(), 1e-5);
        EXPECT_THAT(fix->ids, ::testing::ElementsAre(447, 1782, 3003));
      }
    }
  }
}

TEST(FixPose, follows_the_conventions_of_camera_and_marker) {
  // Camera straight up at heading 0 below a marker at heading 0: X right of O in the image, Y above O.
  MarkerRegistry registry;
  registry.markers.push_back({0, Vec3(0.0, 0.0, 2.0), 0.0, 0});
  Random random(2);
  const auto markers = seen(view_from({0.0, 0.0, 0.5}, 0.0), registry, paper_camera(), 0.0, random);
  EXPECT_GT(markers[0].x_px.x(), markers[0].o_px.x() + 10.0);
  EXPECT_LT(markers[0].y_px.y(), markers[0].o_px.y() - 10.0);
  const auto fix = fix_pose(Stamp{}, markers, registry, paper_camera(), with_tilt_sigma(0.0, 0.1));
  ASSERT_TRUE(fix.has_value());
  EXPECT_NEAR(angles_of(fix->map_from_camera.linear()).yaw_rad, 0.0, 1e-9);
}

TEST(FixPose, derivatives_agree_with_finite_differences) {
  const CameraModel camera = wide_camera();
  const Eigen::Isometry3d view = view_from({0.3, -0.2, 0.1}, 0.7, 0.05, -0.08);
  const Vec3 point(0.9, 0.4, 1.6);
  const Projection at = *project_dot(view, point, camera);
  constexpr double step = 1e-6;
  for (int k = 0; k < 6; ++k) {
    const auto shifted = [&](double by) {
      Eigen::Isometry3d moved = view;
      if (k < 3) {
        moved.translation()[k] += by;
      } else {
        moved.linear() = Eigen::AngleAxisd(by, Vec3::Unit(k - 3)).toRotationMatrix() * view.linear();
      }
      return project_dot(moved, point, camera)->pixel;
    };
    const Vec2 numeric = (shifted(step) - shifted(-step)) / (2.0 * step);
    EXPECT_LT((numeric - at.jacobian.col(k)).norm(), 1e-4 * (1.0 + numeric.norm())) << "parameter " << k;
  }
}

TEST(FixPose, uses_the_mounts_tilt) {
  Random random(3);
  const MarkerRegistry registry = ceiling();
  const CameraModel camera = paper_camera();
  PoseFixOptions options = with_tilt_sigma(0.0, 0.1);
  options.prior.tilt = rotation_from({radians(2.0), radians(-3.0), 0.0});
  const Eigen::Isometry3d view = view_from({1.1, 1.9, 0.3}, 1.0, radians(2.0), radians(-3.0));
  const auto fix = fix_pose(Stamp{}, seen(view, registry, camera, 0.0, random), registry, camera, options);
  ASSERT_TRUE(fix.has_value());
  // Not exactly: these dots are images of points, not of discs.
  EXPECT_LT(error_of(*fix, view).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(FixPose, height_prior_sharpens_the_height) {
  Random random(4);
  MarkerRegistry registry = ceiling();
  registry.markers.resize(1);
  const CameraModel camera = paper_camera();
  const Eigen::Isometry3d view = view_from({1.1, 1.9, 0.0}, 0.4);
  PoseFixOptions options = with_tilt_sigma(0.0, 0.1);
  const auto markers = seen(view, registry, camera, 0.1, random);
  const auto without = fix_pose(Stamp{}, markers, registry, camera, options);
  options.prior.height_m = 0.0;
  options.prior.height_sigma_m = 0.001;
  const auto with = fix_pose(Stamp{}, markers, registry, camera, options);
  ASSERT_TRUE(without && with);
  EXPECT_LT(with->covariance(2, 2), 0.2 * without->covariance(2, 2));
  EXPECT_LE(with->covariance(2, 2), 1e-6);
}

TEST(FixPose, says_nothing_of_unregistered_or_doubled_markers) {
  Random random(5);
  const MarkerRegistry registry = ceiling();
  const CameraModel camera = paper_camera();
  const auto markers = seen(view_from({1.1, 1.9, 0.3}, 0.4), registry, camera, 0.0, random);
  EXPECT_FALSE(fix_pose(Stamp{}, {}, registry, camera, {}));
  EXPECT_FALSE(fix_pose(Stamp{}, markers, MarkerRegistry{}, camera, {}));
  EXPECT_FALSE(
      fix_pose(Stamp{}, std::vector{markers[0], markers[0]}, registry, camera, with_tilt_sigma(0.0, 0.1)));
  const auto fix = fix_pose(Stamp{}, std::vector{markers[0], markers[0], markers[1]}, registry, camera,
                            with_tilt_sigma(0.0, 0.1));
  ASSERT_TRUE(fix.has_value());
  EXPECT_THAT(fix->ids, ::testing::ElementsAre(1782));
}

TEST(FixPose, leaves_out_a_moved_marker_when_two_others_agree_and_refuses_when_only_one_is_left) {
  Random random(6);
  const MarkerRegistry surveyed = ceiling();
  MarkerRegistry hanging = surveyed;
  hanging.markers[1].position_m.x() += 0.1;
  const CameraModel camera = wide_camera();
  const Eigen::Isometry3d view = view_from({1.1, 1.9, 1.1}, 0.4);
  const PoseFixOptions options = with_tilt_sigma(0.0, 0.1);
  auto markers = seen(view, hanging, camera, 0.0, random);
  const auto fix = fix_pose(Stamp{}, markers, surveyed, camera, options);
  ASSERT_TRUE(fix.has_value());
  EXPECT_THAT(fix->ids, ::testing::ElementsAre(447, 3003));
  EXPECT_LT(error_of(*fix, view).cwiseAbs().maxCoeff(), 1e-6);
  markers.pop_back();
  EXPECT_FALSE(fix_pose(Stamp{}, markers, surveyed, camera, options));
}

// Two markers, one displaced by 7 cm: a robot that leans over would see them much like this.
TEST(FixPose, does_not_explain_a_moved_marker_by_a_tilt_that_cannot_be) {
  Random random(6);
  MarkerRegistry surveyed;
  surveyed.markers.push_back({447, Vec3(0.3, 2.0, 2.6), radians(20.0), 0});
  surveyed.markers.push_back({1782, Vec3(2.0, 2.1, 2.6), radians(-70.0), 0});
  MarkerRegistry hanging = surveyed;
  hanging.markers[1].position_m.x() += 0.07;
  const CameraModel camera = wide_camera();
  const auto markers = seen(view_from({1.1, 1.9, 1.1}, 0.4), hanging, camera, 0.0, random);
  PoseFixOptions options = with_tilt_sigma(radians(0.12), 0.03);
  options.prior.height_m = 1.1;
  options.prior.height_sigma_m = 0.003;
  EXPECT_FALSE(fix_pose(Stamp{}, markers, surveyed, camera, options));
  options.max_prior_chi2 = 1e9;
  EXPECT_TRUE(fix_pose(Stamp{}, markers, surveyed, camera, options)) << "a fix without that limit";
}

TEST(FixPose, of_four_markers_leaves_out_two_moved_ones_or_refuses) {
  Random random(7);
  MarkerRegistry surveyed = ceiling();
  surveyed.markers.push_back({77, Vec3(0.8, 1.7, 2.6), 0.3, 0});
  MarkerRegistry hanging = surveyed;
  hanging.markers[0].position_m.y() -= 0.05;  // the optimal marker too
  hanging.markers[2].yaw_rad += radians(5.0);
  const CameraModel camera = wide_camera();
  const Eigen::Isometry3d view = view_from({1.1, 1.9, 1.1}, 0.4);
  const auto markers = seen(view, hanging, camera, 0.0, random);
  const auto fix = fix_pose(Stamp{}, markers, surveyed, camera, with_tilt_sigma(0.0, 0.1));
  ASSERT_TRUE(fix.has_value());
  EXPECT_THAT(fix->ids, ::testing::ElementsAre(1782, 77));
  EXPECT_LT(error_of(*fix, view).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(FixPose, is_not_moved_far_by_one_bad_dot) {
  Random random(9);
  const MarkerRegistry registry = ceiling();
  const CameraModel camera = paper_camera();
  const Eigen::Isometry3d view = view_from({1.1, 1.9, 0.3}, 0.4);
  auto markers = seen(view, registry, camera, 0.05, random);
  const auto clean = fix_pose(Stamp{}, markers, registry, camera, with_tilt_sigma(0.0, 0.05));
  markers[1].dots[4].center_px.x() += 3.0;
  const auto disturbed = fix_pose(Stamp{}, markers, registry, camera, with_tilt_sigma(0.0, 0.05));
  ASSERT_TRUE(clean && disturbed);
  EXPECT_LT((clean->map_from_camera.translation() - disturbed->map_from_camera.translation()).norm(), 0.001);
  EXPECT_GT(disturbed->residual_px, clean->residual_px);
}

TEST(FixPose, refuses_dots_that_fit_no_pose) {
  Random random(10);
  MarkerRegistry registry = ceiling();
  registry.markers.resize(1);
  const CameraModel camera = paper_camera();
  auto markers = seen(view_from({1.1, 1.9, 0.3}, 0.4), registry, camera, 5.0, random);
  EXPECT_FALSE(fix_pose(Stamp{}, markers, registry, camera, with_tilt_sigma(0.0, 0.05)));
  markers[0].dots[0].center_px.x() = std::numeric_limits<double>::quiet_NaN();
  markers[0].o_px = markers[0].dots[0].center_px;
  EXPECT_FALSE(fix_pose(Stamp{}, markers, registry, camera, with_tilt_sigma(0.0, 0.05)));
}

TEST(FixPose, needs_no_p3p_where_the_tilt_is_known) {
  // Noise of 1 px puts P3P on 12 cm off by many degrees; the start from the tilt prior is not affected.
  Random random(12);
  MarkerRegistry registry = ceiling();
  registry.markers.resize(1);
  const CameraModel camera = paper_camera();
  PoseFixOptions options = with_tilt_sigma(radians(0.1), 1.0);
  options.max_residual_px = 5.0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Isometry3d view = view_from({1.1, 1.9, 0.3}, random.uniform(-3.1, 3.1));
    const auto fix = fix_pose(Stamp{}, seen(view, registry, camera, 1.0, random), registry, camera, options);
    ASSERT_TRUE(fix.has_value());
    EXPECT_LT(error_of(*fix, view).head<2>().norm(), 0.03);
    EXPECT_LT(error_of(*fix, view).tail<3>().cwiseAbs().maxCoeff(), radians(4.0));
  }
}

}  // namespace
}  // namespace lodestar
