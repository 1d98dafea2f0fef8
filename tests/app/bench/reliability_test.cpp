#include "app/bench/reliability.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "maps/random.hpp"

namespace lodestar {
namespace {

TEST(Reliability, sorts_readings_by_what_was_stated) {
  const std::vector<StatedOutcome> outcomes{
      {0.4, false}, {0.95, true}, {0.93, false}, {1.0, true}, {0.9, true}};
  const std::vector<ReliabilityBin> bins = reliability(outcomes);
  ASSERT_EQ(bins.size(), 3U) << "empty bins are left out";
  EXPECT_EQ(bins[0].count, 1);
  EXPECT_DOUBLE_EQ(bins[0].share_right, 0.0);
  EXPECT_EQ(bins[1].count, 3) << "0.9 to 0.99";
  EXPECT_DOUBLE_EQ(bins[1].low, 0.9);
  EXPECT_NEAR(bins[1].mean_stated, (0.95 + 0.93 + 0.9) / 3.0, 1e-12);
  EXPECT_NEAR(bins[1].share_right, 2.0 / 3.0, 1e-12);
  EXPECT_EQ(bins[2].count, 1) << "a probability of 1 is in the last bin";
  EXPECT_DOUBLE_EQ(bins[2].high, 1.0);
}

TEST(Reliability, of_an_honest_forecaster_lies_on_the_diagonal) {
  Random random(5);
  std::vector<StatedOutcome> outcomes;
  for (int i = 0; i < 200000; ++i) {
    const double probability = random.uniform();
    outcomes.push_back({probability, random.uniform() < probability});
  }
  for (const ReliabilityBin& bin : reliability(outcomes)) {
    const double sigma = std::sqrt(bin.mean_stated * (1.0 - bin.mean_stated) / bin.count);
    EXPECT_NEAR(bin.share_right, bin.mean_stated, 4.0 * sigma + 1e-3) << bin.low;
  }
  EXPECT_NEAR(brier_score(outcomes), 1.0 / 6.0, 0.003) << "the mean of p (1 - p)";
}

TEST(Reliability, of_nothing_is_nothing) {
  EXPECT_TRUE(reliability({}).empty());
  EXPECT_EQ(brier_score({}), 0.0);
}

}  // namespace
}  // namespace lodestar
