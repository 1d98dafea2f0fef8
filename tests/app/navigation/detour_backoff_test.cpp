#include "app/navigation/detour_backoff.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace lodestar {
namespace {

Stamp at(double time_s) {
  return Stamp(from_seconds(time_s));
}

/// The times of the changes of a robot that would change its way in each scan.
std::vector<double> changes_until(double end_s, double speed_mps) {
  DetourBackoff backoff;
  std::vector<double> changes_s;
  for (int scans = 0; 0.1 * scans < end_s; ++scans) {
    const double now_s = 0.1 * scans;
    if (!backoff.may_change(at(now_s))) continue;
    backoff.changed(at(now_s), {speed_mps * now_s, 0.0});
    changes_s.push_back(now_s);
  }
  return changes_s;
}

TEST(DetourBackoff, WaitsTwiceAsLongAfterEachChangeThatLedNowhere) {
  const std::vector<double> changes_s = changes_until(32.0, 0.0);
  const std::vector<double> wanted_s{0.0, 1.0, 3.0, 7.0, 15.0, 23.0, 31.0};
  ASSERT_EQ(changes_s.size(), wanted_s.size());
  for (std::size_t i = 0; i < wanted_s.size(); ++i) EXPECT_NEAR(changes_s[i], wanted_s[i], 0.11) << i;
}

TEST(DetourBackoff, LetsARobotThatComesOnChangeEachSecond) {
  EXPECT_GE(changes_until(20.0, 0.35).size(), 18U);
}

TEST(DetourBackoff, BeginsAnewWhereTheRobotHasComeOn) {
  DetourBackoff backoff;
  for (const double now_s : {0.0, 1.0, 3.0}) backoff.changed(at(now_s), Vec2::Zero());
  EXPECT_FALSE(backoff.may_change(at(6.9)));
  backoff.changed(at(7.0), {0.31, 0.0});
  EXPECT_FALSE(backoff.may_change(at(7.9)));
  EXPECT_TRUE(backoff.may_change(at(8.1)));
}

}  // namespace
}  // namespace lodestar
