#include "app/drive/state_keeper.hpp"

#include <functional>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

class StateKeeperTest : public testing::Test {
 protected:
  /// What the keeper tells goes to `told`.
  std::function<void(Severity, const std::string&)> tell = [this](Severity, const std::string& words) {
    told.push_back(words);
  };

  std::optional<LearnedState> learned() {
    ++asked;
    LearnedState state;
    state.wheel_scales.mean.x() = 1.0 + 0.001 * asked;
    state.wheel_scales.covariance = 1e-6 * Eigen::Matrix3d::Identity();
    return state;
  }

  TemporaryFolder folder;
  StateOwner owner{.robot = "cart", .track_width_m = 0.4, .wheel_step_m = 0.001};
  std::vector<std::string> told;
  int asked = 0;
};

TEST_F(StateKeeperTest, writes_once_a_minute_and_at_the_end) {
  StateKeeper keeper(folder / "state.yaml", owner, tell);
  EXPECT_FALSE(keeper.load());
  for (int step = 0; step <= 150 * 50; ++step)
    keeper.step(Stamp(std::chrono::milliseconds(20 * step)), [this] { return learned(); });
  EXPECT_EQ(asked, 2) << "after one and two minutes of 2.5";
  keeper.end(learned());
  const StateFile file = load_state(folder / "state.yaml", owner);
  ASSERT_TRUE(file.state) << file.warning;
  EXPECT_EQ(file.state->wheel_scales.mean.x(), 1.003) << "the last one";
  EXPECT_TRUE(told.empty());
}

TEST_F(StateKeeperTest, keeps_what_was_written_when_nothing_is_known_at_the_end) {
  save_state(*learned(), owner, folder / "state.yaml");
  StateKeeper keeper(folder / "state.yaml", owner, tell);
  EXPECT_TRUE(keeper.load());
  keeper.end(std::nullopt);
  EXPECT_TRUE(load_state(folder / "state.yaml", owner).state);
}

TEST_F(StateKeeperTest, tells_what_is_not_used_and_what_cannot_be_written) {
  StateKeeper other(folder.write("state.yaml", "format: lodestar-state\nversion: 9\n"), owner, tell);
  EXPECT_FALSE(other.load());
  ASSERT_EQ(told.size(), 1U);
  EXPECT_NE(told.back().find("not used"), std::string::npos) << told.back();

  StateKeeper nowhere(folder / "missing" / "state.yaml", owner, tell);
  nowhere.end(learned());
  ASSERT_EQ(told.size(), 2U);
  EXPECT_NE(told.back().find("not kept"), std::string::npos) << told.back();
}

}  // namespace
}  // namespace lodestar
