#include "app/navigation/holding_points.hpp"

#include <gtest/gtest.h>
#include <initializer_list>

namespace lodestar {
namespace {

class HoldingPointsTest : public ::testing::Test {
 protected:
  /// One control step of 20 ms.
  void step(std::initializer_list<HoldingPoint> held_by, const Vec2& moves_m = Vec2::Zero()) {
    now_ += std::chrono::milliseconds(20);
    robot_.position_m += moves_m;
    points_.stand_at(robot_);
    for (const HoldingPoint& point : held_by) points_.add(point, now_);
  }

  const HoldingPoint post_{.position_m = {1.0, 0.0}, .may_go = false};
  const HoldingPoint someone_{.position_m = {0.0, 1.0}, .may_go = true};
  Stamp now_ = Stamp{} + std::chrono::seconds(1);
  Pose2 robot_;
  HoldingPoints points_;
};

TEST_F(HoldingPointsTest, KnowsWhatHasHeldTheRobotForTwoSeconds) {
  for (int i = 0; i < 95; ++i) step({post_});
  EXPECT_TRUE(points_.points(now_).empty());
  for (int i = 0; i < 10; ++i) step({post_});
  ASSERT_EQ(points_.points(now_).size(), 1U);
  EXPECT_EQ(points_.points(now_).front().position_m, post_.position_m);
  EXPECT_TRUE(points_.points(now_ + std::chrono::seconds(31)).empty());
}

/// Between two scans the field may have nothing against what little it wants, and lets it go a millimetre.
TEST_F(HoldingPointsTest, HoldsARobotThatCreeps) {
  for (int i = 0; i < 150; ++i) {
    if (i % 5 == 0) {
      step({post_});
    } else {
      step({}, Vec2(0.0002, 0.0));
    }
  }
  EXPECT_EQ(points_.points(now_).size(), 1U);
}

TEST_F(HoldingPointsTest, HoldsNoRobotThatGoesOn) {
  for (int i = 0; i < 300; ++i) step({post_}, Vec2(0.001, 0.0));
  for (int i = 0; i < 300; ++i) {
    robot_.yaw_rad = wrap_angle(robot_.yaw_rad + 0.002);
    step({post_});
  }
  EXPECT_TRUE(points_.points(now_).empty());
}

/// Held now and then, as people pass, it is not held.
TEST_F(HoldingPointsTest, HoldsNoRobotThatIsHeldNowAndThen) {
  for (int i = 0; i < 1000; ++i) {
    if (i % 20 == 0) {
      step({post_});
    } else {
      step({});
    }
  }
  EXPECT_TRUE(points_.points(now_).empty());
}

TEST_F(HoldingPointsTest, WaitsLongerForSomeoneWhoMayGo) {
  for (int i = 0; i < 1240; ++i) step({someone_});
  EXPECT_TRUE(points_.points(now_).empty());
  step({post_});
  EXPECT_TRUE(points_.points(now_).empty()) << "held by that only just now";
  for (int i = 0; i < 20; ++i) step({someone_});
  ASSERT_EQ(points_.points(now_).size(), 1U);
  EXPECT_TRUE(points_.points(now_).front().may_go);
}

}  // namespace
}  // namespace lodestar
