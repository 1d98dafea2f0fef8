#include "localization/pose/pose_fix.hpp"

#include <Eigen/Cholesky>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>

#include "localization/pose/map_estimate.hpp"
#include "maps/paper_camera.hpp"
#include "maps/random.hpp"

#include "tests/localization/seen_markers.hpp"

namespace lodestar {
namespace {

CameraModel wide_camera() {
  CameraModel camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx_px = camera.fy_px = 320.0;
  camera.cx_px = 319.5;
  camera.cy_px = 239.5;
  camera.distortion = Distortion::plumb_bob;
  camera.coefficients = {-0.06, 0.01, 0.0004, -0.0003};
  return camera;
}

PoseFixOptions with_tilt_sigma(std::optional<double> tilt_sigma_rad, double dot_sigma_px) {
  PoseFixOptions options;
  options.prior.tilt_sigma_rad = tilt_sigma_rad;
  options.dot_sigma_px = dot_sigma_px;
  return options;
}

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

/// One way of looking: the covariance must tell the truth about the errors.
struct Mode {
  const char* name;
  std::optional<double> tilt_sigma_rad;
  std::size_t markers;
  double noise_px;
};

/// Mean of the normalized squared errors over the degrees of freedom that the mode leaves.
double mean_nees(const Mode& mode, int trials, const std::vector<int>& free_axes) {
  Random random(7);
  const CameraModel camera = paper_camera();
  MarkerRegistry registry = ceiling();
  registry.markers.resize(mode.markers);
  const double tilt = mode.tilt_sigma_rad.value_or(radians(1.0));
  double sum = 0.0;
  for (int i = 0; i < trials; ++i) {
    const Eigen::Isometry3d view =
        view_from({1.1, 1.9, 0.3}, random.uniform(-3.1, 3.1), tilt * random.normal(), tilt * random.normal());
    const auto fix = fix_pose(Stamp{}, seen(view, registry, camera, mode.noise_px, random), registry, camera,
                              with_tilt_sigma(mode.tilt_sigma_rad, mode.noise_px));
    if (!fix) return std::numeric_limits<double>::infinity();
    const Eigen::VectorXd error = error_of(*fix, view)(free_axes);
    const Eigen::MatrixXd covariance = fix->covariance(free_axes, free_axes);
    sum += error.dot(covariance.ldlt().solve(error));
  }
  return sum / trials;
}

TEST(FixPose, covariance_is_honest_in_every_mode) {
  // The band is that of the 95 % limits of a mean of chi-square values; 2 % on top for Huber's loss.
  constexpr int trials = 10000;
  for (const Mode& mode : {Mode{"exact tilt", 0.0, 1, 0.1}, Mode{"tilt within 0.3 deg", radians(0.3), 1, 0.1},
                           Mode{"tilt within 0.3 deg, three markers", radians(0.3), 3, 0.1},
                           Mode{"free, two markers", std::nullopt, 2, 0.05},
                           Mode{"free, three markers", std::nullopt, 3, 0.1}}) {
    const bool exact = mode.tilt_sigma_rad == 0.0;
    const std::vector<int> free_axes =
        exact ? std::vector<int>{0, 1, 2, 5} : std::vector<int>{0, 1, 2, 3, 4, 5};
    const auto dof = static_cast<double>(free_axes.size());
    EXPECT_NEAR(mean_nees(mode, trials, free_axes), dof, 1.96 * std::sqrt(2.0 * dof / trials) + 0.02 * dof)
        << mode.name;
  }
}

/// The registry's markers as hands have hung them: every dot somewhat off its place.
std::vector<DetectedMarker> seen_glued(const Eigen::Isometry3d& view, const MarkerRegistry& registry,
                                       const CameraModel& camera, double off_m, Random& random) {
  std::vector<DetectedMarker> markers = seen(view, registry, camera, 0.0, random);
  for (std::size_t i = 0; i < markers.size(); ++i) {
    const Eigen::Isometry3d map_from_marker = lodestar::map_from_marker(registry, registry.markers[i]);
    for (MarkerDot& dot : markers[i].dots) {
      Vec2 glued = cell_in_marker(dot.cell);
      for (double& coordinate : glued) coordinate += off_m * random.normal();
      dot.center_px = *camera.project(view.inverse() * map_from_marker * Vec3(glued.x(), glued.y(), 0.0));
      dot.sigma_px = 0.01;
    }
  }
  return markers;
}

TEST(FixPose, says_what_all_frames_share_where_dots_are_off_their_places) {
  Random random(5);
  const CameraModel camera = paper_camera();
  const Eigen::Isometry3d view = view_from({1.1, 1.9, 1.1}, 0.4);
  for (const std::size_t markers : {1U, 3U}) {
    MarkerRegistry registry = ceiling();
    registry.markers.resize(markers);
    PoseFixOptions options = with_tilt_sigma(radians(0.1), 0.0);
    options.dot_place_sigma_m = 0.0001;
    double sum = 0.0;
    constexpr int trials = 2000;
    for (int i = 0; i < trials; ++i) {
      const auto fix =
          fix_pose(Stamp{}, seen_glued(view, registry, camera, 0.0001, random), registry, camera, options);
      ASSERT_TRUE(fix);
      const Vec6 error = error_of(*fix, view);
      sum += error.dot(fix->shared_covariance.ldlt().solve(error));
    }
    EXPECT_NEAR(sum / trials, 6.0, 1.96 * std::sqrt(12.0 / trials) + 0.02 * 6.0) << markers;
  }
}

TEST(FixPose, shares_nothing_where_dots_are_where_they_should_be) {
  Random random(5);
  const auto fix =
      fix_pose(Stamp{}, seen(view_from({1.1, 1.9, 0.3}, 0.4), ceiling(), paper_camera(), 0.1, random),
               ceiling(), paper_camera(), with_tilt_sigma(radians(0.3), 0.1));
  ASSERT_TRUE(fix);
  EXPECT_EQ(fix->shared_covariance.norm(), 0.0);
}

TEST(FixPose, covariance_covers_the_mirrored_view_of_a_lonely_marker) {
  // With the tilt free, 12 cm at 2.3 m look almost alike from two sides. The errors are not Gaussian then,
  // but the truth must not be far outside of what the covariance says. Without the second view every third
  // is.
  Random random(8);
  const CameraModel camera = paper_camera();
  MarkerRegistry registry = ceiling();
  registry.markers.resize(1);
  int far_outside = 0;
  constexpr int trials = 1000;
  for (int i = 0; i < trials; ++i) {
    const Eigen::Isometry3d view =
        view_from({1.1, 1.9, 0.3}, 0.5, radians(1.0) * random.normal(), radians(1.0) * random.normal());
    const auto fix = fix_pose(Stamp{}, seen(view, registry, camera, 0.1, random), registry, camera,
                              with_tilt_sigma(std::nullopt, 0.1));
    ASSERT_TRUE(fix.has_value());
    const Vec6 error = error_of(*fix, view);
    far_outside += error.dot(fix->covariance.ldlt().solve(error)) > 60.0 ? 1 : 0;
  }
  EXPECT_LT(far_outside, trials / 10);
}

/// Root mean square errors from one place with the tilt known, 9 dots at 2.6 m with noise of 0.05 px.
struct KnownTiltErrors {
  Vec6 rms = Vec6::Zero();
  Vec6 claimed = Vec6::Zero();  ///< deviations by the covariance, which is the Cramer-Rao bound here
};

KnownTiltErrors errors_with_known_tilt(const Vec3& position) {
  const CameraModel camera = paper_camera();
  MarkerRegistry registry;
  registry.markers.push_back({0b010110111001, Vec3(0.0, 0.0, 2.6), 0.0, 0});
  Random random(11);
  KnownTiltErrors errors;
  constexpr int trials = 1000;
  for (int i = 0; i < trials; ++i) {
    const Eigen::Isometry3d view = view_from(position, random.uniform(-3.1, 3.1));
    const auto fix = fix_pose(Stamp{}, seen(view, registry, camera, 0.05, random), registry, camera,
                              with_tilt_sigma(0.0, 0.05));
    errors.rms += error_of(*fix, view).cwiseAbs2() / trials;
    errors.claimed += fix->covariance.diagonal() / trials;
  }
  errors.rms = errors.rms.cwiseSqrt();
  errors.claimed = errors.claimed.cwiseSqrt();
  return errors;
}

TEST(FixPose, with_the_tilt_known_reaches_the_cramer_rao_bound) {
  // From half a metre aside: 0.46 mm lateral, 2.3 mm in height, 0.05 degrees; in the marker's middle less.
  const KnownTiltErrors aside = errors_with_known_tilt({-0.5, 0.0, 0.0});
  EXPECT_LT(aside.rms[0], 1.15 * 0.00046);
  EXPECT_LT(aside.rms[2], 1.15 * 0.0023);
  EXPECT_LT(aside.rms[5], 1.15 * radians(0.05));
  const KnownTiltErrors below = errors_with_known_tilt({0.06, -0.06, 0.0});
  EXPECT_LT(below.rms.head<2>().maxCoeff(), 0.0001);
  for (const int axis : {0, 1, 2, 5}) {
    EXPECT_NEAR(aside.rms[axis], aside.claimed[axis], 0.08 * aside.claimed[axis]);
    EXPECT_NEAR(below.rms[axis], below.claimed[axis], 0.08 * below.claimed[axis]);
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

// Two markers, one 7 cm off: a robot that leans over would see them much like this.
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
  EXPECT_TRUE(fix_pose(Stamp{}, markers, surveyed, camera, options)) << "without that limit it does";
}

TEST(FixPose, of_four_markers_leaves_out_two_moved_ones_or_refuses) {
  Random random(7);
  MarkerRegistry surveyed = ceiling();
  surveyed.markers.push_back({77, Vec3(0.8, 1.7, 2.6), 0.3, 0});
  MarkerRegistry hanging = surveyed;
  hanging.markers[0].position_m.y() -= 0.05;  // even of the optimal marker
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
  // Noise of 1 px spoils P3P on 12 cm by many degrees; the start from the prior's tilt does not mind.
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
