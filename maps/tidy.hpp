#pragma once

#include <cmath>

namespace lodestar {

/// A number for a file, to nine decimals and never minus zero: 90, not 90.00000000000001.
inline double tidy(double value) {
  constexpr double per_unit = 1e9;
  return std::round(value * per_unit) / per_unit + 0.0;
}

}  // namespace lodestar
