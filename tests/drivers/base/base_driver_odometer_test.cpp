#include <gtest/gtest.h>
#include <limits>

#include "drivers/base/base_driver.hpp"

#include "tests/drivers/base/base_driver_fixture.hpp"

// Wheel travel from the base's odometer.
namespace lodestar {
namespace {

using namespace testing;
using std::chrono::milliseconds;

TEST_F(BaseDriverTest, unwraps_the_odometer_both_ways) {
  constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
  constexpr std::int32_t least = std::numeric_limits<std::int32_t>::min();
  odometer = {most - 5, least + 5};
  const BaseFeedback first = period();
  ASSERT_EQ(first.travel.size(), 1U);
  EXPECT_EQ(first.travel[0].left_m, 0.0) << "travel counts from the first reading";
  odometer = {least + 4, most - 4};
  const BaseFeedback second = period();
  ASSERT_EQ(second.travel.size(), 1U);
  EXPECT_DOUBLE_EQ(second.travel[0].left_m, 0.010);
  EXPECT_DOUBLE_EQ(second.travel[0].right_m, -0.010);
  EXPECT_EQ(second.travel[0].stamp, now);
  EXPECT_EQ(driver.counts().odd_frames, 0U);
}

TEST_F(BaseDriverTest, gives_all_readings_since_the_last_poll_oldest_first) {
  for (int i = 1; i <= 3; ++i) {
    now += milliseconds(20);
    odometer.left_mm = 10 * i;
    base_speaks();
  }
  const BaseFeedback feedback = driver.poll(now);
  ASSERT_EQ(feedback.travel.size(), 3U);
  EXPECT_DOUBLE_EQ(feedback.travel[2].left_m, 0.020);
  EXPECT_EQ(feedback.travel[1].stamp - feedback.travel[0].stamp, Duration(milliseconds(20)));
  EXPECT_TRUE(driver.poll(now).travel.empty());
}

TEST_F(BaseDriverTest, takes_no_leap_when_the_base_restarts_its_odometer) {
  odometer = {123'456, 123'456};
  period();
  odometer = {0, 0};
  EXPECT_TRUE(period().travel.empty());
  EXPECT_EQ(driver.counts().odd_frames, 1U);
  odometer = {10, 20};
  const BaseFeedback feedback = period();
  ASSERT_EQ(feedback.travel.size(), 1U);
  EXPECT_DOUBLE_EQ(feedback.travel[0].left_m, 0.010);
}

TEST_F(BaseDriverTest, loses_no_travel_by_a_broken_reading) {
  period();
  odometer = {10 + (1 << 20), 10};
  EXPECT_TRUE(period().travel.empty());
  odometer = {20, 20};
  const BaseFeedback feedback = period();
  ASSERT_EQ(feedback.travel.size(), 1U);
  EXPECT_DOUBLE_EQ(feedback.travel[0].left_m, 0.020);
  EXPECT_DOUBLE_EQ(feedback.travel[0].right_m, 0.020);
  EXPECT_EQ(driver.counts().odd_frames, 1U);
}

TEST_F(BaseDriverTest, does_not_believe_a_reading_from_the_past) {
  period();
  odometer = {10, 10};
  bus.arriving.push_back({now - milliseconds(1), agilex::encode_odometer(odometer)});
  EXPECT_TRUE(driver.poll(now).travel.empty());
  EXPECT_EQ(driver.counts().odd_frames, 1U);
}

}  // namespace
}  // namespace lodestar
