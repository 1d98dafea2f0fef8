#include "app/report/nees.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "maps/random.hpp"

namespace lodestar {
namespace {

/// Runs of a filter whose errors are `factor` times as large as it believes.
std::vector<std::vector<NeesSample>> runs_with(double factor, NeesPhase phase = NeesPhase::steady) {
  Random random(5);
  std::vector<std::vector<NeesSample>> runs(50);
  for (std::vector<NeesSample>& run : runs) {
    for (int second = 0; second < 200; ++second) {
      double nees = 0.0;
      for (int k = 0; k < 3; ++k) nees += std::pow(factor * random.normal(), 2.0);
      run.push_back({phase, second, nees});
    }
  }
  return runs;
}

TEST(Nees, of_an_honest_filter_lies_within_its_bounds) {
  const NeesVerdict verdict = nees_verdict(runs_with(1.0)).value();
  EXPECT_NEAR(verdict.mean, 3.0, 0.1);
  EXPECT_NEAR(verdict.share_inside, 0.95, 0.05);
  // The 95 % interval of chi-square with 150 degrees of freedom is 117.985..185.800.
  EXPECT_NEAR(verdict.low, 117.985 / 50.0, 0.001);
  EXPECT_NEAR(verdict.high, 185.800 / 50.0, 0.001);
  EXPECT_EQ(verdict.seconds, 200);
}

TEST(Nees, of_a_filter_too_sure_or_too_cautious_does_not) {
  const NeesVerdict sure = nees_verdict(runs_with(1.5)).value();
  EXPECT_GT(sure.mean, sure.high);
  EXPECT_LT(sure.share_inside, 0.1);
  const NeesVerdict cautious = nees_verdict(runs_with(0.7)).value();
  EXPECT_LT(cautious.mean, cautious.low);
  EXPECT_LT(cautious.share_inside, 0.1);
}

TEST(Nees, is_told_by_phase) {
  const auto runs = runs_with(1.0, NeesPhase::gap);
  EXPECT_TRUE(nees_verdict(runs, NeesPhase::gap));
  EXPECT_FALSE(nees_verdict(runs, NeesPhase::steady));
  EXPECT_FALSE(nees_verdict({}));
}

}  // namespace
}  // namespace lodestar
