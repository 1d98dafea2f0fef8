#pragma once

#include <array>
#include <cstdint>

// Confidence of a marker's reading, from the gray values of its dots (paper, Eq. (2) and (3)).
namespace lodestar {

inline constexpr int lowest_dot_gray = 200;       ///< lower limit of the sum in Eq. (3)
inline constexpr double confidence_max = 2730.3;  ///< H_max: maximum of f(x), at x = 245.06
inline constexpr double confidence_min = 478.2;   ///< H_min: f(200), the minimum on 200..255

/// f of Eq. (2): gray-value histogram of 200 marker images, fitted by two Gaussians.
double gray_frequency(double gray);

/// Contribution of a pixel of each gray value to Eq. (3), before the division by N; zero below 200.
const std::array<double, 256>& confidence_of_gray();

/// P(S) of Eq. (3), accumulated pixel by pixel.
class ConfidenceSum {
 public:
  /// A pixel darker than 200 counts in N only.
  void add(std::uint8_t gray) {
    sum_ += of_gray_[gray];
    ++pixels_;
  }

  /// 0 for no pixels.
  [[nodiscard]] double value() const { return pixels_ > 0 ? sum_ / pixels_ : 0.0; }

 private:
  const std::array<double, 256>& of_gray_ = confidence_of_gray();
  double sum_ = 0.0;
  int pixels_ = 0;
};

}  // namespace lodestar
