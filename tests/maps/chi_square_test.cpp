#include "maps/chi_square.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace lodestar {
namespace {

TEST(ChiSquare, quantiles_are_those_of_the_tables) {
  EXPECT_NEAR(chi_square_quantile(0.95, 1.0), 3.841, 0.0005);
  EXPECT_NEAR(chi_square_quantile(0.999, 3.0), 16.266, 0.0005);
  EXPECT_NEAR(chi_square_quantile(0.025, 150.0), 117.985, 0.0005);
  EXPECT_NEAR(chi_square_quantile(0.975, 150.0), 185.800, 0.0005);
}

TEST(ChiSquare, with_two_degrees_of_freedom_is_exponential) {
  for (const double probability : {0.001, 0.5, 0.99})
    EXPECT_NEAR(chi_square_quantile(probability, 2.0), -2.0 * std::log(1.0 - probability), 1e-9);
}

}  // namespace
}  // namespace lodestar
