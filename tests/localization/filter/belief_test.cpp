#include "localization/filter/belief.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

/// Any pose, with wheels that are not as built.
Belief some_belief() {
  Belief belief;
  belief.mean << 1.0, -2.0, 0.7, 1.01, 0.98, 1.02, 0.003, -0.002, 0.001, 0.9, -2.1, 0.6, 0.01;
  belief.covariance.setIdentity();
  return belief;
}

PoseFilterOptions without_noise() {
  PoseFilterOptions options;
  options.wheel_noise_m_per_sqrt_m = 0.0;
  options.wheel_scale_drift_per_sqrt_m = 0.0;
  options.wheel_step_m = 0.0;
  options.fix_sigma_floor_m = 0.0;
  options.fix_sigma_floor_rad = 0.0;
  return options;
}

TEST(Belief, a_quarter_circle_ends_where_it_should) {
  // Radius 1 m, track width 0.4 m: the wheels roll on circles of 0.8 m and 1.2 m.
  const Pose2 end = rolled({}, 0.8 * radians(90.0), 1.2 * radians(90.0), 0.4);
  EXPECT_NEAR(end.position_m.x(), 1.0, 1e-12);
  EXPECT_NEAR(end.position_m.y(), 1.0, 1e-12);
  EXPECT_NEAR(end.yaw_rad, radians(90.0), 1e-12);
}

TEST(Belief, moves_its_covariance_as_finite_differences_say) {
  const Belief belief = some_belief();
  const PoseFilterOptions options = without_noise();
  const WheelTravel travel{Stamp(from_seconds(0.02)), 0.010, 0.013};
  const Belief after = moved(belief, travel, options);
  Belief::Covariance transition(belief.mean.size(), belief.mean.size());
  for (Eigen::Index k = 0; k < belief.mean.size(); ++k) {
    constexpr double step = 1e-6;
    Belief more = belief;
    Belief less = belief;
    more.mean[k] += step;
    less.mean[k] -= step;
    transition.col(k) =
        (moved(more, travel, options).mean - moved(less, travel, options).mean) / (2.0 * step);
  }
  // The chord approximates the arc: an error of some 1e-5 at a turn of half a degree.
  EXPECT_LT((after.covariance - transition * transition.transpose()).cwiseAbs().maxCoeff(), 2e-5);
}

TEST(Belief, way_in_parts_is_the_way_as_a_whole) {
  const Belief belief = some_belief();
  const PoseFilterOptions options;
  const WheelTravel end{Stamp(from_seconds(0.02)), 0.010, 0.013};
  const WheelTravel middle{Stamp(from_seconds(0.01)), 0.005, 0.0065};
  const Belief at_once = moved(belief, end, options);
  const Belief in_parts = moved(moved(belief, middle, options), end, options);
  EXPECT_LT((at_once.mean - in_parts.mean).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((at_once.covariance - in_parts.covariance).cwiseAbs().maxCoeff(), 1e-5);
}

// A jolt of one wheel between two fixes looks like wheels of unequal size.
TEST(Belief, takes_from_one_fix_only_a_share_of_what_it_says_about_the_wheels) {
  PoseFilterOptions options;
  const PlanarFix start{.covariance = 1e-6 * Eigen::Matrix3d::Identity()};
  const Belief before =
      moved(belief_from(start, {}, initial_scales(options), options), {{}, 1.0, 1.0}, options);
  PlanarFix turned = start;
  turned.map_from_base = before.map_from_base();
  // As from wheels that differ by 2 %, or from a jolt of 2 cm.
  turned.map_from_base.yaw_rad += 0.05;
  const auto unequal = [](const Belief& belief) { return belief.mean[4] - belief.mean[3]; };
  const Belief after = corrected(before, turned, options);
  options.scales_learned_by_one_fix = 1.0;
  const Belief at_once = corrected(before, turned, options);
  EXPECT_NEAR(unequal(after), PoseFilterOptions{}.scales_learned_by_one_fix * unequal(at_once), 1e-12);
  EXPECT_GT(unequal(at_once), 0.015);
  EXPECT_GT(after.covariance(3, 3) - after.covariance(3, 4),
            at_once.covariance(3, 3) - at_once.covariance(3, 4))
      << "with a correspondingly larger variance";
  EXPECT_TRUE(after.map_from_base().position_m == at_once.map_from_base().position_m);
}

TEST(Belief, by_one_fix_is_as_unsure_as_fix_and_survey_together) {
  PoseFilterOptions options = without_noise();
  options.fix_sigma_floor_m = 0.003;
  options.fix_sigma_floor_rad = 0.002;
  PlanarFix fix;
  fix.map_from_base = {{1.0, 2.0}, 3.0};
  fix.covariance = Vec3(16e-6, 16e-6, 9e-6).asDiagonal();
  const Belief belief = belief_from(fix, {}, initial_scales(options), options);
  EXPECT_EQ(belief.map_from_base().position_m, fix.map_from_base.position_m);
  EXPECT_NEAR(belief.covariance(0, 0), 25e-6, 1e-18);
  EXPECT_NEAR(belief.covariance(2, 2), 13e-6, 1e-18);
  // A second fix from the same view has the same survey error: only the fix's own noise differs.
  PlanarFix again = fix;
  again.map_from_base.position_m.x() += 0.008;
  EXPECT_NEAR(squared_distance(belief, again, options), 0.008 * 0.008 / (2.0 * 16e-6), 1e-9);
}

/// Of the fix's sigma of 5 mm, 3 mm are the shared error of its markers.
PlanarFix fix_that_shares() {
  PlanarFix fix;
  fix.map_from_base = {{1.0, 2.0}, 3.0};
  fix.covariance = Vec3(25e-6, 25e-6, 13e-6).asDiagonal();
  fix.shared_covariance = Vec3(9e-6, 9e-6, 4e-6).asDiagonal();
  return fix;
}

TEST(Belief, does_not_average_away_what_the_same_markers_err_by) {
  const PoseFilterOptions options = without_noise();
  const PlanarFix fix = fix_that_shares();
  Belief belief = belief_from(fix, {}, initial_scales(options), options);
  EXPECT_NEAR(belief.covariance(0, 0), 25e-6, 1e-11);
  for (int i = 1; i < 1000; ++i) belief = corrected(belief, fix, options);
  EXPECT_NEAR(belief.covariance(0, 0), 9e-6 + 16e-6 / 1000.0, 1e-10);
  EXPECT_NEAR(belief.covariance(2, 2), 4e-6 + 9e-6 / 1000.0, 1e-10);
}

TEST(Belief, takes_another_marker_to_err_for_itself_but_the_same_one_only_once) {
  const PoseFilterOptions options = without_noise();
  PlanarFix fix = fix_that_shares();
  fix.ids = {7};
  Belief belief = belief_from(fix, {}, initial_scales(options), options);
  for (int i = 0; i < 1000; ++i) belief = corrected(belief, fix, options);
  EXPECT_NEAR(belief.covariance(0, 0), 9e-6, 1e-7);
  fix.ids = {8};
  for (int i = 0; i < 1000; ++i) belief = corrected(belief, fix, options);
  EXPECT_NEAR(belief.covariance(0, 0), 0.5 * 9e-6, 1e-7) << "the mean of two markers' errors";
  for (int i = 0; i < 1000; ++i) {
    fix.ids = i % 3 == 0 ? std::vector<int>{7, 8} : std::vector<int>{7 + i % 2};
    belief = corrected(belief, fix, options);
  }
  EXPECT_NEAR(belief.covariance(0, 0), 0.5 * 9e-6, 1e-7) << "also when the markers come and go";
  belief = moved(belief, {{}, 2.0, 2.0}, options);
  const double far = belief.covariance(0, 0);
  for (int i = 0; i < 1000; ++i) belief = corrected(belief, fix, options);
  EXPECT_LT(belief.covariance(0, 0), 0.8 * far) << "2 m on, the same markers have other errors";
}

TEST(Belief, takes_fewer_markers_to_err_as_these_did_and_by_more) {
  const PoseFilterOptions options = without_noise();
  PlanarFix by_three = fix_that_shares();
  by_three.shared_covariance *= 0.25;
  Belief belief = belief_from(by_three, {}, initial_scales(options), options);
  for (int i = 1; i < 1000; ++i) belief = corrected(belief, by_three, options);
  PlanarFix by_one = fix_that_shares();
  by_one.covariance += 1e6 * Eigen::Matrix3d::Identity();  // carries no information
  const Belief after = corrected(belief, by_one, options);
  EXPECT_NEAR(after.covariance(0, 0), belief.covariance(0, 0), 1e-12);
  EXPECT_NEAR(after.covariance(6, 6), 9e-6, 1e-7);
  EXPECT_NEAR(after.covariance(0, 6), -0.5 * 9e-6, 1e-7) << "half of it is in the pose";
}

/// Else what rounding makes of them grows, on some drives until the covariance is none
/// (`ExploredReplay`).
TEST(Belief, covariances_are_symmetric_after_each_correction) {
  const PoseFilterOptions options;
  const PlanarFix fix{.covariance = 1e-6 * Eigen::Matrix3d::Identity()};
  const VisualOdometryIncrement motion{.covariance = 1e-6 * Eigen::Matrix3d::Identity(), .sway_m = 0.003};
  Belief belief = belief_from(fix, {}, initial_scales(options), options);
  belief = moved(with_keyframe(belief, motion.sway_m, options), {{}, 0.1, 0.2}, options);
  belief.covariance(2, 8) += 1e-9;
  const auto asymmetry = [](const Belief& of) {
    return (of.covariance - of.covariance.transpose()).cwiseAbs().maxCoeff();
  };
  EXPECT_EQ(asymmetry(corrected(belief, fix, options)), 0.0);
  EXPECT_EQ(asymmetry(corrected(belief, motion, false, options)), 0.0);
  EXPECT_EQ(asymmetry(corrected(belief, motion, true, options)), 0.0);
}

}  // namespace
}  // namespace lodestar
