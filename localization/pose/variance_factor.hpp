#pragma once

#include <algorithm>

namespace lodestar {

/// Variance factor of the dots, the variance of unit weight of least squares (Mikhail, Observations and Least
/// Squares, 1976): true variance over the dots' own. A dot's own variance covers noise; coarse sampling of
/// its edge by a sharp lens, and calibration errors, appear only in the residuals of a frame's fit. A
/// property of the camera, learned fit after fit from 1, and never less: a fit that is good by chance adds no
/// confidence.
class VarianceFactor {
 public:
  static constexpr double greatest = 25.0;  // sigmas five times as large: beyond it, something else is wrong

  VarianceFactor() = default;
  /// Begins with a value learned earlier, as far as it is possible.
  explicit VarianceFactor(double learned) : value_(std::clamp(learned, 1.0, greatest)), weight_(kept) {}

  /// Adds one fit: its sum of squared residuals in sigmas, with the dots' variances scaled by `value()`, and
  /// the expectation of this sum, the number of measurements less that of the parameters they determine. One
  /// bad fit counts for at most `most` times its expectation.
  void add(double chi2, double freedom) {
    constexpr double most = 3.0;
    weight_ = std::min(weight_ + freedom, remembered);
    const double excess = (std::min(chi2, most * freedom) - freedom) / weight_;
    value_ = std::clamp(value_ * (1.0 + excess), 1.0, greatest);
  }

  [[nodiscard]] double value() const { return value_; }

 private:
  static constexpr double assumed = 200.0;        // weight of the initial value, in residuals
  static constexpr double kept = 5000.0;          // of a value learned earlier: some 400 fits by one marker
  static constexpr double remembered = 50'000.0;  // some 4000 fits by one marker

  double value_ = 1.0;
  double weight_ = assumed;
};

}  // namespace lodestar
