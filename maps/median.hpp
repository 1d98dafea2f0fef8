#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace lodestar {

/// Median; of an even number of values the upper of the two middle ones; 0 when there are none. Reorders the
/// values.
inline double median_in_place(std::span<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// The same of a copy.
inline double median(std::vector<double> values) {
  return median_in_place(values);
}

}  // namespace lodestar
