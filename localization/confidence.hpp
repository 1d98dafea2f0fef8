#pragma once

#include <array>
#include <cstdint>

// How sure a marker's reading is, from the gray values of its dots (paper, Eq. (2) and (3)).
namespace lodestar {

/// How many pixels of a marker have each gray value: n_x of Eq. (3).
using GrayHistogram = std::array<std::uint32_t, 256>;

inline constexpr int lowest_dot_gray = 200;       ///< where the sum of Eq. (3) begins
inline constexpr double confidence_max = 2730.3;  ///< H_max: the greatest f(x), at x = 245.06
inline constexpr double confidence_min = 478.2;   ///< H_min: f(200), the least on 200..255

/// f of Eq. (2): how often 200 marker images showed this gray value, fitted by two Gaussians.
double gray_frequency(double gray);

/// P(S) of Eq. (3), 0 for no pixels. Pixels darker than 200 count in N only.
double marker_confidence(const GrayHistogram& histogram);

}  // namespace lodestar
