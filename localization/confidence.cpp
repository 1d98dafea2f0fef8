#include "localization/confidence.hpp"

#include <cmath>
#include <cstddef>
#include <numeric>

namespace lodestar {
namespace {

using ConfidenceTable = std::array<double, 256>;

/// What one pixel adds to Eq. (3) before the division by N.
ConfidenceTable confidence_of_gray() {
  ConfidenceTable table{};
  for (std::size_t gray = lowest_dot_gray; gray < table.size(); ++gray) {
    table[gray] =
        (gray_frequency(static_cast<double>(gray)) - confidence_min) / (confidence_max - confidence_min);
  }
  return table;
}

}  // namespace

double gray_frequency(double gray) {
  const double near_white = gray - 245.4;
  const double darker = gray - 208.6;
  return 2634.0 * std::exp(-near_white * near_white / 196.84) +
         525.0 * std::exp(-darker * darker / 791.30);  // (2)
}

double marker_confidence(const GrayHistogram& histogram) {
  static const ConfidenceTable table = confidence_of_gray();
  const auto pixels = std::accumulate(histogram.begin(), histogram.end(), std::uint64_t{0});
  if (pixels == 0) return 0.0;
  const double sum = std::inner_product(table.begin(), table.end(), histogram.begin(), 0.0);
  return sum / static_cast<double>(pixels);  // (3)
}

}  // namespace lodestar
