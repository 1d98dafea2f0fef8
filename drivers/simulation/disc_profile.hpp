#pragma once

#include <vector>

namespace lodestar {

/// Share of a disc's light at a point after a Gaussian blur: 1 well inside, 0 far outside, about one half on
/// the rim. Lengths are in sigmas of the blur, so one table serves every blur.
class DiscProfile {
 public:
  DiscProfile();

  /// Beyond this distance from the rim the profile is constant to a few parts in ten thousand.
  static constexpr double reach = 3.5;

  /// The profile of one radius.
  class Row {
   public:
    /// At a point at distance `inside` within the rim (negative: outside).
    [[nodiscard]] double at(double inside) const {
      const double place = (inside + reach) * steps_per_sigma;
      if (!(place > 0.0)) return 0.0;
      const auto left = static_cast<int>(place);
      if (left >= columns - 1) return values_[columns - 1];
      return values_[left] + (place - left) * (values_[left + 1] - values_[left]);
    }

   private:
    friend class DiscProfile;
    explicit Row(const float* values) : values_(values) {}
    const float* values_;
  };

  [[nodiscard]] Row of_radius(double radius) const;
  [[nodiscard]] Row of_straight_edge() const;

 private:
  static constexpr int steps_per_sigma = 16;
  static constexpr int columns = static_cast<int>(2 * reach * steps_per_sigma) + 1;

  std::vector<float> values_;
};

}  // namespace lodestar
