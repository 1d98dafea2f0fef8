#pragma once

namespace lodestar {

/// What a chi-square variable exceeds with probability 1 - `probability` (strictly between 0 and 1).
double chi_square_quantile(double probability, double degrees_of_freedom);

}  // namespace lodestar
