#include "localization/detection/confidence.hpp"

#include <cmath>
#include <cstddef>

namespace lodestar {

double gray_frequency(double gray) {
  const double near_white = gray - 245.4;
  const double darker = gray - 208.6;
  return 2634.0 * std::exp(-near_white * near_white / 196.84) +
         525.0 * std::exp(-darker * darker / 791.30);  // (2)
}

const std::array<double, 256>& confidence_of_gray() {
  static const std::array<double, 256> table = [] {
    std::array<double, 256> result{};
    for (std::size_t gray = lowest_dot_gray; gray < result.size(); ++gray) {
      result[gray] = (gray_frequency(static_cast<double>(gray)) - confidence_min) /
                     (confidence_max - confidence_min);  // (3)
    }
    return result;
  }();
  return table;
}

}  // namespace lodestar
