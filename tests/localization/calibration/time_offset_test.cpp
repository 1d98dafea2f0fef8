#include "localization/calibration/time_offset.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "maps/geometry.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

using std::chrono::milliseconds;

constexpr double track_width_m = 0.4;
constexpr double rate_radps = 0.9;

/// A robot that stands, turns for `turn_s` and stands again; it reaches the rate in half a second.
struct Turn {
  double turn_s = 20.0;
  double stands_s = 2.0;
  double accelerates_s = 0.5;

  [[nodiscard]] double yaw_rad(double time_s) const {
    const auto risen_s = [this](double since_s) {  // integral of a ramp from 0 to 1
      const double in_ramp_s = std::clamp(since_s, 0.0, accelerates_s);
      return 0.5 * in_ramp_s * in_ramp_s / accelerates_s + std::max(since_s - accelerates_s, 0.0);
    };
    return rate_radps * (risen_s(time_s - stands_s) - risen_s(time_s - stands_s - turn_s));
  }
  [[nodiscard]] double lasts_s() const { return 2.0 * stands_s + turn_s + accelerates_s; }
};

/// Frames 10 times a second, with 0.05 degrees of noise and late stamps; wheels 50 times a second in whole
/// millimetres, on a track that is 1 % wider than it is thought to be.
std::optional<TimeOffset> estimated(const Turn& turn, double late_s, std::uint64_t seed) {
  Random random(seed);
  std::vector<HeadingSample> frames;
  std::vector<WheelTravel> wheels;
  for (double time_s = 0.5; time_s < turn.lasts_s() - 0.5; time_s += 0.1) {
    const double yaw_rad = turn.yaw_rad(time_s) + radians(0.05) * random.normal();
    frames.push_back({Stamp(from_seconds(time_s + late_s)), wrap_angle(yaw_rad)});
  }
  for (double time_s = 0.0; time_s < turn.lasts_s(); time_s += 0.02) {
    const double rim_m = 0.5 * 1.01 * track_width_m * turn.yaw_rad(time_s);
    const double whole_m = std::floor(1000.0 * rim_m) / 1000.0;
    wheels.push_back({Stamp(from_seconds(time_s)), -whole_m, whole_m});
  }
  return estimate_time_offset(frames, wheels, track_width_m);
}

TEST(TimeOffset, is_seen_at_the_begin_and_the_end_of_a_turn) {
  for (const double late_s : {-0.03, 0.0, 0.02, 0.08}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const std::optional<TimeOffset> found = estimated({}, late_s, seed);
      ASSERT_TRUE(found) << late_s;
      EXPECT_LT(found->sigma_s, 0.004);
      EXPECT_NEAR(found->late_s, late_s, 4.0 * found->sigma_s) << "seed " << seed;
      EXPECT_EQ(found->is_significant(), late_s != 0.0) << "seed " << seed;
    }
  }
}

TEST(TimeOffset, is_not_seen_in_a_turn_without_begin_and_end) {
  EXPECT_FALSE(estimated({.turn_s = 60.0, .stands_s = -10.0}, 0.05, 1));
}

TEST(TimeOffset, is_not_seen_while_the_robot_stands) {
  EXPECT_FALSE(estimated({.turn_s = 0.0, .stands_s = 10.0}, 0.05, 1));
}

}  // namespace
}  // namespace lodestar
