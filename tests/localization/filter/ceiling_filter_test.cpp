#include <gtest/gtest.h>

#include "tests/localization/rolling_world.hpp"

// Visual odometry on the ceiling in the pose filter.
namespace lodestar {
namespace {

using namespace testing;

/// A camera that sways, and visual-odometry increments between its frames.
struct Pictures {
  World& world;
  double sway_m = 0.0;
  double sigma_m = 0.0;
  double sigma_rad = 0.0;
  Stamp keyframe_stamp{};
  Pose2 kept{};

  [[nodiscard]] Pose2 place() {
    return {world.truth.position_m + sway_m * Vec2(world.random.normal(), world.random.normal()),
            world.truth.yaw_rad};
  }

  bool keep(PoseFilter& filter) {
    kept = place();
    keyframe_stamp = world.reported.stamp;
    return filter.set_keyframe(keyframe_stamp, sway_m);
  }

  bool show(PoseFilter& filter, bool keeps, const Pose2& slip = {}) {
    const Pose2 now = place() * slip;
    VisualOdometryIncrement motion{
        .from = keyframe_stamp, .to = world.reported.stamp, .then_from_now = inverse(kept) * now};
    motion.then_from_now.position_m += sigma_m * Vec2(world.random.normal(), world.random.normal());
    motion.then_from_now.yaw_rad += sigma_rad * world.random.normal();
    motion.covariance = Vec3(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal();
    motion.sway_m = sway_m;
    const bool agrees = filter.add_motion(motion, keeps);
    if (agrees && keeps) {
      kept = now;
      keyframe_stamp = world.reported.stamp;
    }
    return agrees;
  }
};

/// As drive() without fixes, but with a frame every fifth step, of which every fifth becomes the keyframe.
/// Returns how many increments were refused: one in a thousand may be, by chance.
int drive_by_pictures(World& world, PoseFilter& filter, Pictures& pictures, double from_s, double for_s) {
  int refused = 0;
  for (int i = 1; i <= std::lround(for_s * 10.0); ++i) {
    drive(world, filter, from_s + 0.1 * (i - 1), 0.1, false);
    if (!pictures.show(filter, i % 5 == 0)) ++refused;
  }
  return refused;
}

PoseFilterOptions noisy_wheels() {
  PoseFilterOptions options = without_floor();
  options.wheel_noise_m_per_sqrt_m = 0.004;
  return options;
}

TEST(CeilingFilter, bridges_a_gap_better_than_wheels) {
  World world;
  world.noise_m_per_sqrt_m = 0.004;
  PoseFilter filter(noisy_wheels());
  drive(world, filter, 0.0, 6.0, true);
  Pictures pictures{.world = world, .sway_m = 0.004, .sigma_m = 0.0005, .sigma_rad = 0.0003};
  ASSERT_TRUE(pictures.keep(filter));
  World blind_world = world;
  PoseFilter blind = filter;
  drive(blind_world, blind, 6.0, 20.0, false);
  EXPECT_EQ(drive_by_pictures(world, filter, pictures, 6.0, 20.0), 0);
  const auto sigma_m = [](const PoseFilter& of) {
    return std::sqrt(of.estimate()->covariance.topLeftCorner<2, 2>().trace());
  };
  EXPECT_LT(sigma_m(filter), 0.25 * sigma_m(blind));
  EXPECT_LT(position_error(world, filter), 3.0 * sigma_m(filter));
  EXPECT_EQ(filter.estimate()->last_fix, at(6.0));
  EXPECT_EQ(filter.estimate()->last_agreed, at(26.0));
}

TEST(CeilingFilter, is_as_sure_as_it_may_be) {
  constexpr int runs = 200;
  double sum = 0.0;
  int refused = 0;
  for (int run = 1; run <= runs; ++run) {
    World world;
    world.random = Random(static_cast<std::uint64_t>(run));
    world.noise_m_per_sqrt_m = 0.004;
    const PoseFilterOptions options = noisy_wheels();
    PoseFilter filter(options);
    drive(world, filter, 0.0, 6.0, true, 0.003, 0.003);
    Pictures pictures{.world = world, .sway_m = 0.004, .sigma_m = 0.0005, .sigma_rad = 0.0003};
    ASSERT_TRUE(pictures.keep(filter));
    refused += drive_by_pictures(world, filter, pictures, 6.0, 10.0);
    sum += nees(world, filter);
  }
  EXPECT_NEAR(sum / runs, 3.0, 1.96 * std::sqrt(6.0 / runs));
  EXPECT_LT(refused, runs / 5) << "of 100 increments per run";
}

TEST(CeilingFilter, late_pictures_end_like_prompt_ones) {
  World world;
  world.noise_m_per_sqrt_m = 0.004;
  PoseFilter prompt(noisy_wheels());
  drive(world, prompt, 0.0, 2.0, true);
  Pictures pictures{.world = world, .sigma_m = 0.001, .sigma_rad = 0.001};
  ASSERT_TRUE(pictures.keep(prompt));
  drive(world, prompt, 2.0, 0.2, false);
  PoseFilter late = prompt;
  VisualOdometryIncrement motion{.from = pictures.keyframe_stamp,
                                 .to = world.reported.stamp,
                                 .then_from_now = inverse(pictures.kept) * world.truth,
                                 .covariance = 1e-6 * Eigen::Matrix3d::Identity()};
  EXPECT_TRUE(prompt.add_motion(motion, true));
  World later = world;
  drive(world, prompt, 2.2, 0.1, false);
  drive(later, late, 2.2, 0.1, false);
  EXPECT_TRUE(late.add_motion(motion, true));
  EXPECT_LT((late.estimate()->map_from_base.position_m - prompt.estimate()->map_from_base.position_m).norm(),
            1e-12);
  EXPECT_LT((late.estimate()->covariance - prompt.estimate()->covariance).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(CeilingFilter, expects_what_the_wheels_say) {
  World world;
  PoseFilter filter(without_floor());
  EXPECT_FALSE(filter.set_keyframe(at(0.0), 0.0)) << "no estimate yet";
  drive(world, filter, 0.0, 1.0, true, 1e-5, 1e-5);
  EXPECT_FALSE(filter.expected_motion(at(1.0))) << "no keyframe yet";
  const Pose2 then = world.truth;
  ASSERT_TRUE(filter.set_keyframe(at(1.0), 0.0));
  drive(world, filter, 1.0, 0.4, false);
  const std::optional<MotionExpectation> expected = filter.expected_motion(at(1.4));
  ASSERT_TRUE(expected);
  EXPECT_EQ(expected->from, at(1.0));
  EXPECT_LT((expected->then_from_now.position_m - (inverse(then) * world.truth).position_m).norm(), 1e-4);
  EXPECT_FALSE(filter.expected_motion(at(1.5))) << "beyond the wheel readings";
}

TEST(CeilingFilter, knows_only_the_picture_that_it_keeps) {
  World world;
  PoseFilter filter(without_floor());
  drive(world, filter, 0.0, 1.0, true);
  Pictures pictures{.world = world, .sigma_m = 0.001, .sigma_rad = 0.001};
  ASSERT_TRUE(pictures.keep(filter));
  pictures.keyframe_stamp = at(0.9);
  drive(world, filter, 1.0, 0.1, false);
  EXPECT_FALSE(pictures.show(filter, false));
}

/// After two seconds under markers, with a keyframe.
struct Watching {
  World world{};
  PoseFilter filter{without_floor()};
  Pictures pictures{.world = world, .sigma_m = 0.001, .sigma_rad = 0.001};

  Watching() {
    drive(world, filter, 0.0, 2.0, true);
    EXPECT_TRUE(pictures.keep(filter));
  }
};

// Either the wheels slip or the camera sees an object that it carries along: the filter cannot tell which.
TEST(CeilingFilter, refuses_what_contradicts_the_wheels_and_then_believes_neither_alone) {
  Watching watching;
  auto& [world, filter, pictures] = watching;
  const Pose2 slip{{0.0, 0.0}, radians(5.0)};
  drive(world, filter, 2.0, 0.1, false);
  EXPECT_TRUE(pictures.show(filter, false));
  EXPECT_FALSE(pictures.show(filter, false, slip));
  drive(world, filter, 2.1, 0.1, false);
  EXPECT_TRUE(pictures.show(filter, false)) << "one contradiction has no effect";
  EXPECT_EQ(filter.estimate()->last_agreed, at(2.2));
  EXPECT_FALSE(pictures.show(filter, false, slip));
  EXPECT_FALSE(pictures.show(filter, false, slip));
  EXPECT_GT(std::sqrt(filter.estimate()->covariance(2, 2)), radians(5.0)) << "it covers both";
  drive(world, filter, 2.2, 0.1, false);
  EXPECT_TRUE(pictures.show(filter, false));
  EXPECT_EQ(filter.estimate()->last_agreed, at(2.2)) << "ignored until a fix agrees";
  EXPECT_EQ(filter.add_fix(world.fix(0.002, 0.002)), FixOutcome::accepted);
  drive(world, filter, 2.3, 0.1, false);
  EXPECT_TRUE(pictures.show(filter, false));
  EXPECT_EQ(filter.estimate()->last_agreed, at(2.4));
}

/// Half a metre after its wheels began to slip, a robot was off by centimetres and claimed millimetres.
TEST(CeilingFilter, grows_uncertain_where_wheels_and_ceiling_disagree_until_a_fix_agrees) {
  Watching watching;
  auto& [world, filter, pictures] = watching;
  world.scales = {1.0, 0.6};
  for (const double begin_s : {2.0, 2.2, 2.4, 2.6, 2.8}) {
    drive(world, filter, begin_s, 0.2, false);
    pictures.show(filter, false);
  }
  EXPECT_GT(position_error(world, filter), 0.05);
  EXPECT_LT(nees(world, filter), 16.0);
  const double before_rad = std::sqrt(filter.estimate()->covariance(2, 2));
  world.scales = {1.0, 1.0};
  drive(world, filter, 3.0, 1.0, true);
  EXPECT_LT(position_error(world, filter), 0.01);
  EXPECT_LT(std::sqrt(filter.estimate()->covariance(2, 2)), 0.1 * before_rad);
}

}  // namespace
}  // namespace lodestar
