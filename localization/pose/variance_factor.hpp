#pragma once

#include <algorithm>

namespace lodestar {

/// How much larger the variance of dots is than what they say of themselves: the variance of unit weight of
/// least squares (Mikhail, Observations and Least Squares, 1976). A dot knows of noise; that the lens is so
/// sharp that pixels sample its edge too coarsely, or calibrated only so well, shows in what is left when all
/// dots of a frame have been fitted by one pose. It is a property of the camera, learned fit after fit,
/// beginning with 1 and never less: that dots happen to fit well is no reason to be surer.
class VarianceFactor {
 public:
  /// What a fit left: the sum of squared residuals in sigmas, the dots' variances taken `value()` times, and
  /// what it should be, the count of measurements less that of what they determined. One fit that fails badly
  /// tells no more than `most` times what it should.
  void add(double chi2, double freedom) {
    constexpr double most = 3.0;
    weight_ = std::min(weight_ + freedom, remembered);
    const double excess = (std::min(chi2, most * freedom) - freedom) / weight_;
    value_ = std::clamp(value_ * (1.0 + excess), 1.0, greatest);
  }

  [[nodiscard]] double value() const { return value_; }

 private:
  static constexpr double assumed = 200.0;        // the first assumption counts as so many residuals
  static constexpr double remembered = 50'000.0;  // some 4000 fits by one marker
  static constexpr double greatest = 25.0;  // sigmas five times as large: beyond it, something else is wrong

  double value_ = 1.0;
  double weight_ = assumed;
};

}  // namespace lodestar
