#include <algorithm>
#include <gtest/gtest.h>
#include <vector>

#include "maps/obstacle_memory.hpp"
#include "maps/random.hpp"

#include "tests/maps/disc_scan.hpp"

namespace lodestar {
namespace {

using testing::scan_of;
using testing::ScanDisc;

constexpr double leg_m = 0.06;
constexpr double scan_s = 0.1;

/// Where the scanner hits a leg.
Vec2 near_side(const Vec2& leg_in_odom) {
  return leg_in_odom - leg_m * leg_in_odom.normalized();
}

/// Is what is hit of either leg that of someone who has come?
bool is_someone_who_came(const ObstacleMemory& memory, const std::vector<Vec2>& legs_m) {
  return std::ranges::any_of(legs_m, [&](const Vec2& leg) { return memory.has_legs(near_side(leg)); }) &&
         std::ranges::all_of(legs_m, [&](const Vec2& leg) { return memory.has_come(near_side(leg)); });
}

void lose(DeskewedScan& scan, double share, Random& random) {
  for (Ray& ray : scan.rays)
    if (random.uniform() < share) ray.echo = Echo::invalid;
}

/// A memory, and someone on two legs before it.
class Visitor {
 public:
  explicit Visitor(unsigned seed, double lost_share = 0.0) : random_(seed), lost_share_(lost_share) {}

  /// To there, straight and at constant speed; without a time at once.
  void go_to(const std::vector<Vec2>& legs_m, double in_s) {
    const std::vector<Vec2> from_m = legs_m_;
    const int scans = std::max(static_cast<int>(in_s / scan_s), 1);
    for (int scan = 1; scan <= scans; ++scan) {
      for (std::size_t i = 0; i < legs_m.size(); ++i)
        legs_m_[i] = from_m[i] + (legs_m[i] - from_m[i]) * scan / scans;
      look();
    }
  }

  void stand(double for_s) { go_to(legs_m_, for_s); }

  [[nodiscard]] bool has_come() const { return is_someone_who_came(memory_, legs_m_); }

 private:
  void look() {
    DeskewedScan scan = scan_of({ScanDisc{legs_m_[0], leg_m}, ScanDisc{legs_m_[1], leg_m}}, at_s_, random_);
    lose(scan, lost_share_, random_);
    memory_.add(scan);
    at_s_ += scan_s;
  }

  Random random_;
  double lost_share_;
  ObstacleMemory memory_;
  double at_s_ = 0.0;
  std::vector<Vec2> legs_m_{Vec2(2.5, 0.1), Vec2(2.5, -0.1)};
};

/// With a last step right before a scanner that is mounted 10 cm ahead of the middle of a robot of 25 cm.
TEST(WhoHasCome, IsKnownAlsoRightBesideTheRobot) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Visitor visitor(seed);
    visitor.stand(3.0);
    visitor.go_to({Vec2(1.0, 0.1), Vec2(1.0, -0.1)}, 1.0);
    visitor.go_to({Vec2(0.24, 0.1), Vec2(0.24, -0.1)}, 0.2);
    visitor.stand(12.0);
    EXPECT_TRUE(visitor.has_come()) << seed;
  }
}

/// Whoever leans on a robot comes to stand in other cells, long after they came.
TEST(WhoHasCome, IsStillKnownWhenTheySwayAfterALongTime) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Visitor visitor(seed);
    visitor.go_to({Vec2(1.0, 0.1), Vec2(1.0, -0.1)}, 1.5);
    visitor.stand(20.0);
    visitor.go_to({Vec2(1.3, 0.4), Vec2(1.3, 0.2)}, 150.0);
    visitor.stand(15.0);
    EXPECT_TRUE(visitor.has_come()) << seed;
  }
}

/// Side by side, but half behind each other: seen in one piece, as parts of a thing are.
TEST(WhoHasCome, HasLegsAlsoWhereOneHidesAPartOfTheOther) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Visitor visitor(seed);
    visitor.go_to({Vec2(0.4, 0.0), Vec2(0.6, 0.1)}, 1.5);
    visitor.stand(25.0);
    EXPECT_TRUE(visitor.has_come()) << seed;
  }
}

/// They came while most beams were lost, or while the scanner was silent.
TEST(WhoHasCome, IsKnownAfterTheScannerWasBlind) {
  for (const bool is_silent : {false, true}) {
    Random random(3);
    ObstacleMemory memory;
    for (int scans = 0; scans < 200; ++scans) {
      const bool is_blind = scans >= 30 && scans < 100;
      if (is_blind && is_silent) continue;
      const std::vector<ScanDisc> someone{{{0.8, 0.0}, 0.1}};
      DeskewedScan scan = scan_of(scans < 60 ? std::vector<ScanDisc>() : someone, scan_s * scans, random);
      if (is_blind) lose(scan, 0.9, random);
      memory.add(scan);
    }
    EXPECT_TRUE(memory.may_go({0.7, 0.0})) << is_silent;
  }
}

/// Someone walks up to the robot and stands before it, while a scanner that is still taken for a good one
/// loses up to three beams of ten: taken for what always stood there, the robot drove off while they touched
/// it, and up to them from a metre away.
TEST(WhoHasCome, IsKnownWhereSomeBeamsAreLost) {
  for (const double share : {0.1, 0.3}) {
    for (const double range_m : {0.4, 1.1}) {
      for (unsigned seed = 1; seed <= 20; ++seed) {
        Visitor visitor(seed, share);
        visitor.stand(3.0);
        visitor.go_to({Vec2(range_m, 0.1), Vec2(range_m, -0.1)}, 2.0);
        visitor.stand(2.0);
        EXPECT_TRUE(visitor.has_come()) << share << ", " << range_m << ", " << seed;
      }
    }
  }
}

/// With a leg half behind the other they are told by the gap between them, which lost beams lie in.
TEST(WhoHasCome, MayGoAsLongAsTheyStandWhereSomeBeamsAreLost) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Visitor visitor(seed, 0.3);
    visitor.stand(3.0);
    visitor.go_to({Vec2(0.4, 0.0), Vec2(0.6, 0.1)}, 2.0);
    visitor.stand(70.0);
    for (int scan = 0; scan < 200; ++scan) {
      visitor.stand(scan_s);
      EXPECT_TRUE(visitor.has_come()) << seed << ", " << scan;
    }
  }
}

/// One beam that hits beside an edge in every scan: a mixed pixel. A walking stick is hit by several.
TEST(WhoHasCome, IsHitByMoreThanOneBeam) {
  const Vec2 place_m(0.62, 0.02);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    for (const bool is_someone : {false, true}) {
      Random random(seed);
      ObstacleMemory memory;
      for (int scans = 0; scans < 36; ++scans) {
        const bool is_there = scans >= 30;
        const std::vector<ScanDisc> stick{{place_m + Vec2(0.01, 0.0), 0.01}};
        DeskewedScan scan =
            scan_of(is_there && is_someone ? stick : std::vector<ScanDisc>(), scan_s * scans, random);
        if (is_there && !is_someone) scan.rays[4] = {scan.newest, Vec2::Zero(), place_m, Echo::hit};
        memory.add(scan);
      }
      EXPECT_EQ(memory.has_come(place_m), is_someone) << seed;
    }
  }
}

/// A disc of 25 cm that comes from the side at 1 m/s, and stands there after four seconds.
class Stander {
 public:
  Stander(unsigned seed, double range_m) : random_(seed), range_m_(range_m) {}

  void look_until(double end_s) {
    for (; at_s_ < end_s; at_s_ += scan_s) {
      const ScanDisc disc{{range_m_, std::min(at_s_, 4.0) - 4.0}, 0.25};
      memory_.add(scan_of({disc}, at_s_, random_));
    }
  }

  [[nodiscard]] Vec2 hit_m() const { return {range_m_ - 0.25, 0.0}; }
  [[nodiscard]] const ObstacleMemory& memory() const { return memory_; }

 private:
  Random random_;
  ObstacleMemory memory_;
  double range_m_;
  double at_s_ = 0.0;
};

/// In a coat, in a wheelchair, or another robot: it may go. What stays was put there.
TEST(WhoHasCome, MayGoForAMinuteThoughTheyShowNoLegs) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Stander stander(seed, 2.0);
    stander.look_until(20.0);
    EXPECT_TRUE(stander.memory().may_go(stander.hit_m())) << seed;
    stander.look_until(60.0);
    EXPECT_TRUE(stander.memory().may_go(stander.hit_m())) << seed;
    EXPECT_FALSE(stander.memory().standing_people_m(Stamp(from_seconds(60.0))).empty()) << seed;
    stander.look_until(70.0);
    EXPECT_FALSE(stander.memory().may_go(stander.hit_m())) << seed;
    EXPECT_TRUE(stander.memory().standing_people_m(Stamp(from_seconds(70.0))).empty()) << seed;
  }
}

/// A robot that drives at 0.6 m/s is with them ten seconds later.
TEST(WhoHasCome, IsKnownFromSixMetresAway) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Stander stander(seed, 6.5);
    stander.look_until(20.0);
    EXPECT_TRUE(stander.memory().has_come(stander.hit_m())) << seed;
  }
}

}  // namespace
}  // namespace lodestar
