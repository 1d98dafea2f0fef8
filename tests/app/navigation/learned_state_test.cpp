#include "app/navigation/learned_state.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/navigation/navigation_setup.hpp"

#include "tests/app/navigation/lab.hpp"
#include "tests/maps/spoilt_file.hpp"
#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

using ::testing::HasSubstr;

StateOwner owner() {
  return state_owner(lab(), "wide");
}

LearnedState some_state() {
  LearnedState state;
  state.wheel_scales.mean = {1.0123456789, 0.987654321, 1.004};
  state.wheel_scales.covariance << 1e-6, 1e-7, 0.0, 1e-7, 2e-6, -3e-7, 0.0, -3e-7, 5e-6;
  state.variance_factor = VarianceFactor(1.7);
  state.registry_variance = 8.0;
  state.distrusted = {{.id = 447, .offset_m = {0.1, -0.05}, .turn_rad = radians(4.0), .fixes = 9},
                      {.id = 1782, .offset_m = {0.0, 0.2}, .turn_rad = 0.0, .fixes = 6}};
  return state;
}

TEST(LearnedState, is_read_back_as_it_was_written_but_less_certain_of_the_wheels) {
  const TemporaryFolder folder;
  save_state(some_state(), owner(), folder / "state.yaml");
  const StateFile file = load_state(folder / "state.yaml", owner());
  ASSERT_TRUE(file.state) << file.warning;
  EXPECT_EQ(file.warning, "");
  EXPECT_EQ(file.state->wheel_scales.mean, some_state().wheel_scales.mean);
  const Eigen::Matrix3d more = file.state->wheel_scales.covariance - some_state().wheel_scales.covariance;
  EXPECT_LT((more - 1e-6 * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-15) << "0.1 % each";
  EXPECT_EQ(file.state->variance_factor.value(), 1.7);
  EXPECT_EQ(file.state->registry_variance, 8.0);
  ASSERT_EQ(file.state->distrusted.size(), 2U);
  EXPECT_EQ(file.state->distrusted[0].id, 447);
  EXPECT_EQ(file.state->distrusted[0].offset_m, some_state().distrusted[0].offset_m);
  EXPECT_NEAR(file.state->distrusted[0].turn_rad, radians(4.0), 1e-12);
  EXPECT_EQ(file.state->distrusted[0].fixes, 9);
}

TEST(LearnedState, of_a_first_drive_is_nothing_without_a_warning) {
  const TemporaryFolder folder;
  const StateFile file = load_state(folder / "state.yaml", owner());
  EXPECT_FALSE(file.state);
  EXPECT_EQ(file.warning, "");
}

TEST(LearnedState, of_another_robot_registry_or_camera_is_not_used) {
  const TemporaryFolder folder;
  Site site = lab();
  save_state(some_state(), state_owner(site, "wide"), folder / "state.yaml");
  const auto warning = [&](const Site& now, const std::string& camera) {
    const StateFile file = load_state(folder / "state.yaml", state_owner(now, camera));
    EXPECT_FALSE(file.state);
    return file.warning;
  };
  EXPECT_THAT(warning(site, "paper"), HasSubstr("the camera's calibration has changed"));
  Site other = site;
  other.robot.name = "another";
  EXPECT_THAT(warning(other, "wide"), HasSubstr("it is of the robot 'nursing robot', this one is 'another'"));
  other = site;
  other.robot.track_width_m += 0.001;
  EXPECT_THAT(warning(other, "wide"), HasSubstr("the robot's wheels are described differently"));
  other = site;
  other.registry.markers.back().sigma = MarkerSigma{.position_m = 0.01};
  EXPECT_THAT(warning(other, "wide"), HasSubstr("the registry of markers has changed"));
  other = site;
  other.registry.markers.back().position_m.y() += 0.001;
  EXPECT_THAT(warning(other, "wide"), HasSubstr("the registry of markers has changed"));
}

TEST(LearnedState, that_cannot_be_read_is_not_used_and_says_where_it_is_wrong) {
  const TemporaryFolder folder;
  save_state(some_state(), owner(), folder / "state.yaml");
  const std::string good = folder.read("state.yaml");
  const auto warning = [&](const std::string& text) {
    const StateFile file = load_state(folder.write("state.yaml", text), owner());
    EXPECT_FALSE(file.state);
    return file.warning;
  };
  EXPECT_THAT(warning(with(good, "version: 1", "version: 2")), HasSubstr("state.yaml:3: found 2, wanted 1"));
  EXPECT_THAT(warning(with(good, "lodestar-state", "lodestar-site")), HasSubstr("state.yaml:2"));
  EXPECT_THAT(warning(with(good, "left: 1.01", "left: 7.01")), HasSubstr("state.yaml:9"));
  EXPECT_THAT(warning(with(good, "covariance: [1e-06", "covariance: [-1e-06")), HasSubstr("state.yaml:9"));
  EXPECT_THAT(warning(good.substr(0, good.size() / 2)), HasSubstr("state.yaml"));
  EXPECT_THAT(warning(with(good, "registry_variance: 8", "registry_variance: 9")),
              HasSubstr("state.yaml:11: found 9, wanted one of 1, 2, 4"));
  EXPECT_THAT(warning(good + "more: 1\n"), HasSubstr("unknown key 'more'"));
  EXPECT_THAT(warning("\x01\x02[{"), HasSubstr("state.yaml"));
  EXPECT_THAT(warning(""), HasSubstr("state.yaml"));
}

TEST(LearnedState, forgets_the_distrust_that_a_person_lifts) {
  const TemporaryFolder folder;
  save_state(some_state(), owner(), folder / "state.yaml");
  EXPECT_EQ(trust_again(folder / "state.yaml", {447, 12}), (std::vector<int>{447}));
  const StateFile file = load_state(folder / "state.yaml", owner());
  ASSERT_TRUE(file.state) << file.warning;
  ASSERT_EQ(file.state->distrusted.size(), 1U);
  EXPECT_EQ(file.state->distrusted[0].id, 1782);
  EXPECT_NEAR(file.state->wheel_scales.covariance(0, 0), 2e-6, 1e-12) << "uncertain by one restart, not two";
}

/// A second in the lab, standing.
NavigationStep stand(const NavigationOptions& options, std::optional<LearnedState>& learned) {
  const Lab lab;
  Simulation simulation = lab.simulation();
  BaseDriver base(simulation.can());
  Navigation navigation(lab.known, options);
  NavigationStep step;
  for (int i = 0; i < 50; ++i) step = navigation.step(sense(lab, simulation, base));
  learned = navigation.learned();
  return step;
}

TEST(LearnedState, is_what_the_next_drive_begins_with) {
  NavigationOptions options = navigation_options(lab().robot);
  std::optional<LearnedState> learned;
  const NavigationStep before = stand(options, learned);
  EXPECT_TRUE(before.distrusted.empty());
  ASSERT_TRUE(learned);
  EXPECT_EQ(learned->wheel_scales.mean, Vec3(Vec3::Ones()));

  options.learned = some_state();
  options.learned->distrusted.front().id = 988;
  const NavigationStep step = stand(options, learned);
  ASSERT_TRUE(learned);
  EXPECT_LT((learned->wheel_scales.mean - some_state().wheel_scales.mean).norm(), 1e-4);
  EXPECT_LT(learned->wheel_scales.covariance.trace(), 1.01 * some_state().wheel_scales.covariance.trace());
  EXPECT_NEAR(learned->variance_factor.value(), 1.7, 0.1);
  EXPECT_EQ(learned->registry_variance, 8.0);
  ASSERT_EQ(step.distrusted.size(), 2U);
  EXPECT_EQ(step.distrusted[0].id, 988);
  EXPECT_EQ(step.distrusted[1].id, 1782);
  EXPECT_LT((step.distrusted[1].offset_m - Vec2(0.0, 0.2)).norm(), 1e-12);

  options.learned = some_state();
  EXPECT_FALSE(stand(options, learned).estimate) << "447 is the only marker in view, and distrusted";
  EXPECT_FALSE(learned) << "nothing to write";
}

}  // namespace
}  // namespace lodestar
