#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "localization/filter/arrival_jitter.hpp"

#include "tests/localization/rolling_world.hpp"

// Readings of the wheels that describe where the robot was.
namespace lodestar {
namespace {

using namespace testing;

constexpr double period_s = 0.02;

/// Starts, stops and turns, with frames of true poses, while the readings arrive `lag_s` late. The largest
/// error of the estimate's position after the first three seconds.
double worst_error_m(double lag_s, PoseFilter& filter) {
  World world;
  std::vector<WheelTravel> rolled{world.reading()};
  double worst_m = 0.0;
  const auto late = static_cast<std::size_t>(std::lround(lag_s / period_s));
  for (int i = 1; i <= 500; ++i) {
    const double now_s = period_s * i;
    const double speed_mps = 0.25 * (1.0 - std::cos(2.0 * now_s));
    const double turn_radps = 0.5 * std::sin(1.3 * now_s);
    world.roll((speed_mps - 0.2 * turn_radps) * period_s, (speed_mps + 0.2 * turn_radps) * period_s, now_s);
    rolled.push_back(world.reading());
    const WheelTravel& old = rolled[rolled.size() > late ? rolled.size() - 1 - late : 0];
    filter.add_travel({at(now_s), old.left_m, old.right_m});
    (void)filter.add_fix(world.fix(0.0005, 0.0005));
    if (now_s > 3.0 && filter.estimate()) worst_m = std::max(worst_m, position_error(world, filter));
  }
  return worst_m;
}

TEST(ReadingLag, is_learned_wherever_the_velocity_changes) {
  PoseFilter late(without_floor());
  EXPECT_LT(worst_error_m(0.04, late), 0.003);  // 20 mm at full speed without it
  PoseFilter prompt(without_floor());
  EXPECT_LT(worst_error_m(0.0, prompt), 0.002);
}

TEST(ArrivalJitter, is_none_at_a_steady_period_with_lost_readings) {
  ArrivalJitter jitter;
  for (int i = 0; i < 500; ++i)
    if (i % 7 != 3) jitter.add(at(period_s * i));
  EXPECT_LT(jitter.sigma_s(), 0.005);
  ArrivalJitter steady;
  for (int i = 0; i < 500; ++i) steady.add(at(period_s * i));
  EXPECT_LT(steady.sigma_s(), 1e-6);
}

TEST(ArrivalJitter, is_about_the_scatter_of_the_delays) {
  for (const double most_s : {0.01, 0.05}) {
    Random random(7);
    std::vector<double> arrivals_s;
    for (int i = 0; i < 1000; ++i) arrivals_s.push_back(period_s * i + random.uniform(0.0, most_s));
    std::ranges::sort(arrivals_s);
    ArrivalJitter jitter;
    double sum_s = 0.0;
    for (const double arrival_s : arrivals_s) {
      jitter.add(at(arrival_s));
      sum_s += jitter.sigma_s();
    }
    const double truth_s = most_s / std::sqrt(12.0);
    EXPECT_NEAR(sum_s / 1000.0, truth_s, 0.5 * truth_s) << most_s;
  }
}

}  // namespace
}  // namespace lodestar
