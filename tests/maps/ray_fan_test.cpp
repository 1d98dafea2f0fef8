#include "maps/ray_fan.hpp"

#include <cmath>
#include <cstddef>
#include <gtest/gtest.h>

namespace lodestar {
namespace {

constexpr double aside_m = 0.1;
constexpr double kept_m = 0.08;
constexpr double gap_m = 0.06;

/// A turn of 720 beams around the origin, each hitting a round wall 5 m away.
class RayFanTest : public ::testing::Test {
 protected:
  RayFanTest() {
    for (int i = 0; i < 720; ++i) scan_.rays.push_back(ray_at(i, 5.0, Echo::hit));
  }

  static Ray ray_at(int beam, double range_m, Echo echo) {
    const Vec2 way(std::cos(radians(0.5 * beam)), std::sin(radians(0.5 * beam)));
    return {Stamp{}, Vec2::Zero(), range_m * way, echo};
  }

  void end_at(int beam, double range_m, Echo echo = Echo::hit) {
    scan_.rays[static_cast<std::size_t>(beam)] = ray_at(beam, range_m, echo);
  }

  [[nodiscard]] bool all_pass(const Vec2& point_m) const {
    const auto passed = RayFan(scan_).passed_across(point_m, aside_m, kept_m, gap_m);
    return passed && passed->all();
  }

  const Vec2 place_m_{3.0, 0.0};  ///< between beam 0 and beam 719
  DeskewedScan scan_;
};

TEST_F(RayFanTest, SaysWhatARayPasses) {
  EXPECT_TRUE(RayFan(scan_).passes(place_m_, 0.01, kept_m));
  EXPECT_FALSE(RayFan(scan_).passes({4.95, 0.0}, 0.01, kept_m)) << "too near to the ray's end";
  EXPECT_FALSE(RayFan(scan_).passes({5.5, 0.0}, 0.01, kept_m)) << "behind it";
  EXPECT_FALSE(RayFan(scan_).passes({0.0, 0.0}, 0.01, kept_m)) << "under the scanner";
  scan_.rays.erase(scan_.rays.begin() + 300, scan_.rays.begin() + 420);
  EXPECT_FALSE(RayFan(scan_).passes(-place_m_, 0.01, kept_m)) << "where no ray looks";
}

/// A wall 10 cm to the left of beam 0: beam 8 ends 1.43 m away, beam 7 1.64 m, and so on.
TEST_F(RayFanTest, GrazesAWallBesideIt) {
  constexpr double wall_m = 0.1;
  for (int beam = 1; beam <= 90; ++beam) end_at(beam, wall_m / std::sin(radians(0.5 * beam)));
  const auto grazes = [&](double x_m, double y_m) { return RayFan(scan_).graze({x_m, y_m}, 0.05, kept_m); };
  EXPECT_TRUE(grazes(1.4, wall_m));
  EXPECT_TRUE(grazes(1.4, wall_m - 0.01));
  EXPECT_FALSE(grazes(1.4, wall_m - 0.04)) << "in front of it";
  EXPECT_FALSE(grazes(0.2, wall_m)) << "at more than ten degrees";
  EXPECT_FALSE(grazes(4.9, wall_m)) << "where one ray ends more than 80 cm behind the other";
  end_at(8, 1.4, Echo::invalid);
  EXPECT_TRUE(grazes(1.4, wall_m)) << "as those beside the lost one show";
  EXPECT_FALSE(RayFan(scan_).graze({-3.0, 0.0}, 0.05, kept_m)) << "a wall that is met at a right angle";
}

TEST_F(RayFanTest, IsPassedByAllWhereNothingIs) {
  EXPECT_TRUE(all_pass(place_m_));
  for (int beam = 0; beam < 720; ++beam) EXPECT_TRUE(all_pass(ray_at(beam, 3.0, Echo::hit).end_m)) << beam;
}

TEST_F(RayFanTest, IsNotPassedByAllWhereOneEnds) {
  for (const int beam : {719, 0, 1}) end_at(beam, 3.0);
  EXPECT_FALSE(all_pass(place_m_));
}

TEST_F(RayFanTest, IsNotPassedByARayThatWasLost) {
  end_at(1, 1.0, Echo::invalid);
  EXPECT_FALSE(all_pass(place_m_));
  EXPECT_TRUE(all_pass({3.0, 0.3})) << "far beside it";
}

/// Right before the scanner they lie closer together than anything that stands on a floor is wide.
TEST_F(RayFanTest, IsPassedByAllWhereLostRaysLeaveNoRoomForAThing) {
  const Vec2 near_m(0.5, 0.0);  // 4.4 mm from ray to ray
  for (const int beam : {2, 3, 4}) end_at(beam, 1.0, Echo::invalid);
  EXPECT_TRUE(all_pass(near_m));
  end_at(6, 1.0);
  EXPECT_TRUE(all_pass(near_m)) << "alone, as if it were lost";
  end_at(5, 1.0, Echo::invalid);
  EXPECT_FALSE(all_pass(near_m));
  end_at(5, 5.0);
  EXPECT_TRUE(all_pass(near_m));
  end_at(5, 0.5);
  EXPECT_FALSE(all_pass(near_m)) << "hit";
}

/// As beside a post: rays that graze its side are lost.
TEST_F(RayFanTest, IsNotPassedByLostRaysBesideOneThatEnds) {
  const Vec2 near_m(0.5, 0.0);  // beam 23 looks past it by 10 cm less 0.3 mm
  for (int beam = 24; beam < 40; ++beam) end_at(beam, 0.5);
  EXPECT_TRUE(all_pass(near_m)) << "far beside it";
  end_at(23, 1.0, Echo::invalid);
  EXPECT_FALSE(all_pass(near_m));
  for (int beam = 24; beam < 40; ++beam) end_at(beam, 5.0);
  EXPECT_TRUE(all_pass(near_m));
}

/// Half of its spot may have met a post there, and half the wall: then its range lies between the two.
TEST_F(RayFanTest, IsNotPassedByARayThatEndsAloneBehind) {
  end_at(1, 4.0);
  EXPECT_FALSE(all_pass(place_m_));
}

/// Two beside each other have met one thing, farther away.
TEST_F(RayFanTest, IsPassedByRaysThatEndTogetherBehind) {
  end_at(1, 4.0);
  end_at(2, 4.0);
  EXPECT_TRUE(all_pass(place_m_));
}

/// A ray that a lost one lies beside is alone as well: what it met may be wider, but nobody saw that.
TEST_F(RayFanTest, IsNotPassedByARayBesideWhichOneWasLost) {
  end_at(4, 1.0, Echo::invalid);
  EXPECT_TRUE(all_pass(place_m_));
  end_at(3, 4.0);
  EXPECT_FALSE(all_pass(place_m_));
}

/// Of a robot that turns the first and the last beam of a turn lie apart.
TEST_F(RayFanTest, IsNotPassedByAllInAGap) {
  scan_.rays.erase(scan_.rays.begin(), scan_.rays.begin() + 3);
  EXPECT_FALSE(all_pass(place_m_));
}

}  // namespace
}  // namespace lodestar
