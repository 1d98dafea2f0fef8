#include "maps/smoothed_ends.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "maps/random.hpp"

namespace lodestar {
namespace {

Ray hit(double x_m, double y_m) {
  return {.end_m = {x_m, y_m}, .echo = Echo::hit};
}

TEST(SmoothedEnds, HalveTheNoiseOfAWall) {
  constexpr double sigma_m = 0.01;
  Random random(1);
  DeskewedScan scan;
  for (int i = 0; i < 2000; ++i) scan.rays.push_back(hit(1.0 + sigma_m * random.normal(), 0.004 * i));
  double sum_m2 = 0.0;
  for (const Vec2& end_m : smoothed_ends_m(scan)) sum_m2 += square(end_m.x() - 1.0);
  EXPECT_LT(std::sqrt(sum_m2 / 2000.0), 0.55 * sigma_m);
}

TEST(SmoothedEnds, LeaveEdgesWhereTheyAre) {
  DeskewedScan scan;
  for (int i = 0; i < 5; ++i) scan.rays.push_back(hit(1.0, 0.004 * i));
  for (int i = 5; i < 10; ++i) scan.rays.push_back(hit(2.0, 0.008 * i));
  scan.rays.push_back({.end_m = {2.0, 0.08}, .echo = Echo::nothing});
  const std::vector<Vec2> ends_m = smoothed_ends_m(scan);
  for (std::size_t i = 0; i < ends_m.size(); ++i)
    EXPECT_NEAR(ends_m[i].x(), scan.rays[i].end_m.x(), 1e-12) << i;
  EXPECT_EQ(ends_m.back(), scan.rays.back().end_m);
}

}  // namespace
}  // namespace lodestar
