#pragma once

#include <cmath>

namespace lodestar {

/// To the nearest 1/per_unit, and never minus zero: numbers for people and messages.
inline double rounded(double value, double per_unit) {
  return std::round(value * per_unit) / per_unit + 0.0;
}

}  // namespace lodestar
