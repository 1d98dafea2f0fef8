#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lodestar {

/// Median; of an even number of values the upper of the two middle ones; 0 when there are none.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace lodestar
