#include "app/navigation/lingering_people.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>

namespace lodestar {
namespace {

using std::chrono::seconds;

/// What a scan shows of a body of 40 cm: five hits side by side, of which the last may count as walking.
std::vector<FieldPoint> body(const Vec2& middle_m, Stamp stamp, bool moves) {
  std::vector<FieldPoint> points;
  for (int i = -2; i <= 2; ++i) {
    const bool is_edge = i == 2;
    points.push_back(
        {stamp, middle_m + Vec2(0.0, 0.1 * i), moves && is_edge ? Presence::person : Presence::standing});
  }
  return points;
}

class LingeringPeopleTest : public ::testing::Test {
 protected:
  using Place = std::function<Vec2(double)>;

  /// Ten scans a second, of which one in so many shows that a part has moved.
  void look(double for_s, const Place& place, int one_in) {
    const Stamp end = now_ + from_seconds(for_s);
    for (; now_ < end; now_ += std::chrono::milliseconds(100)) {
      const bool moves = one_in > 0 && scans_++ % one_in == 0;
      points_ = body(place(lodestar::seconds(now_ - Stamp{})), now_, moves);
      people_.add(points_, now_);
    }
  }

  static Vec2 swaying(double at_s) { return Vec2(2.0 + 0.06 * std::sin(1.9 * at_s), 0.08 * std::cos(at_s)); }

  LingeringPeople people_;
  std::vector<FieldPoint> points_;  ///< of the newest scan
  Stamp now_{};
  int scans_ = 0;
};

TEST_F(LingeringPeopleTest, ShowsWhoSwaysAfterAWhile) {
  look(14.0, swaying, 2);
  EXPECT_TRUE(people_.hits_m(now_).empty());
  look(2.0, swaying, 2);
  EXPECT_EQ(people_.hits_m(now_).size(), 5U);
  for (const Vec2& hit_m : people_.hits_m(now_)) EXPECT_LT((hit_m - Vec2(2.0, 0.0)).norm(), 0.4);
}

TEST_F(LingeringPeopleTest, SaysSoonerWhoStays) {
  const auto stays = [&] { return std::ranges::any_of(points_, &FieldPoint::stays); };
  look(2.5, swaying, 2);
  EXPECT_FALSE(stays());
  look(1.0, swaying, 2);
  EXPECT_TRUE(stays());
  look(0.1, [](double) { return Vec2(2.0, 1.0); }, 1);
  EXPECT_FALSE(stays()) << "somebody else";
}

TEST_F(LingeringPeopleTest, SaysOfNobodyWhoWalksAndOfNoThingThatTheyStay) {
  for (int i = 0; i < 50; ++i) {
    look(0.1, [](double at_s) { return Vec2(2.0, 2.0 * std::sin(0.5 * at_s)); }, 1);
    EXPECT_TRUE(std::ranges::none_of(points_, &FieldPoint::stays)) << i;
  }
  for (int i = 0; i < 50; ++i) {
    look(0.1, [](double) { return Vec2(3.0, 0.0); }, 10);
    EXPECT_TRUE(std::ranges::none_of(points_, &FieldPoint::stays)) << i;
  }
}

/// The edges of a post come and go; what stands and does not sway is planned around as what stands.
TEST_F(LingeringPeopleTest, ShowsNoThing) {
  look(60.0, [](double) { return Vec2(2.0, 0.0); }, 10);
  EXPECT_TRUE(people_.hits_m(now_).empty());
}

TEST_F(LingeringPeopleTest, ShowsNobodyWhoWalks) {
  look(60.0, [](double at_s) { return Vec2(2.0, 2.0 * std::sin(0.5 * at_s)); }, 1);
  EXPECT_TRUE(people_.hits_m(now_).empty());
}

TEST_F(LingeringPeopleTest, ForgetsWhoHasGone) {
  look(30.0, swaying, 2);
  ASSERT_FALSE(people_.hits_m(now_).empty());
  EXPECT_TRUE(people_.hits_m(now_ + seconds(2)).empty());
  people_.add({}, now_ + seconds(2));
  look(5.0, swaying, 2);
  EXPECT_TRUE(people_.hits_m(now_).empty());
}

/// A robot that drives around someone sees other sides of them, half a metre apart.
TEST_F(LingeringPeopleTest, FollowsTheSideThatIsSeen) {
  look(40.0, [](double at_s) -> Vec2 { return swaying(at_s) + Vec2(0.0, 0.0125 * at_s); }, 2);
  EXPECT_FALSE(people_.hits_m(now_).empty());
}

/// Walls and rows of things are wider, whatever comes and goes of them.
TEST_F(LingeringPeopleTest, IsNobodyWhoIsAMetreWide) {
  for (; now_ < Stamp(seconds(30)); now_ += std::chrono::milliseconds(100)) {
    std::vector<FieldPoint> row;
    for (int i = 0; i <= 10; ++i) row.push_back({now_, {2.0, 0.1 * i}, Presence::person});
    people_.add(row, now_);
  }
  EXPECT_TRUE(people_.hits_m(now_).empty());
}

}  // namespace
}  // namespace lodestar
