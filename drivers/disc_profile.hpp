#pragma once

#include <vector>

namespace lodestar {

/// How much of a disc's light falls on a point after a Gaussian blur: 1 deep inside, 0 far outside, about
/// one half on the rim. Lengths are in sigmas of the blur, so one table serves every blur.
class DiscProfile {
 public:
  DiscProfile();

  /// The profile of one radius.
  class Row {
   public:
    /// At a point `inside` of the rim (negative: outside).
    [[nodiscard]] double at(double inside) const;

   private:
    friend class DiscProfile;
    explicit Row(const float* values) : values_(values) {}
    const float* values_;
  };

  [[nodiscard]] Row of_radius(double radius) const;
  [[nodiscard]] Row of_straight_edge() const;

  /// Beyond this distance from the rim the profile is constant.
  static constexpr double reach = 4.0;

 private:
  std::vector<float> values_;
};

}  // namespace lodestar
