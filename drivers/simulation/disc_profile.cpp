#include "drivers/simulation/disc_profile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestar {
namespace {

constexpr int rows_per_octave = 8;
constexpr double smallest_radius = 0.25;
constexpr int octaves = 8;
constexpr int rows = octaves * rows_per_octave + 1;

double normal_cdf(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

/// Integrates the disc over thin chords at height y = radius sin(t), each blurred along its length (a
/// difference of two normal distribution functions) and across (a normal density).
double blurred_disc(double radius, double distance_from_middle) {
  constexpr int slices = 16;
  constexpr double negligible = 4.5;
  const double top = radius > negligible ? std::asin(negligible / radius) : 0.5 * std::numbers::pi;
  double sum = 0.0;
  for (int i = 0; i < slices; ++i) {
    const double t = top * (i + 0.5) / slices;
    const double y = radius * std::sin(t);
    const double half_chord = radius * std::cos(t);
    const double along =
        normal_cdf(half_chord - distance_from_middle) - normal_cdf(-half_chord - distance_from_middle);
    sum += along * std::exp(-0.5 * y * y) * half_chord;
  }
  return 2.0 * sum * (top / slices) / std::sqrt(2.0 * std::numbers::pi);
}

}  // namespace

DiscProfile::DiscProfile() {
  values_.reserve(static_cast<std::size_t>(rows * columns));
  for (int row = 0; row < rows; ++row) {
    const double radius = smallest_radius * std::exp2(static_cast<double>(row) / rows_per_octave);
    for (int column = 0; column < columns; ++column) {
      const double inside = static_cast<double>(column) / steps_per_sigma - reach;
      const double from_middle = std::max(radius - inside, 0.0);
      values_.push_back(static_cast<float>(blurred_disc(radius, from_middle)));
    }
  }
}

DiscProfile::Row DiscProfile::of_radius(double radius) const {
  const double row = rows_per_octave * std::log2(std::max(radius, smallest_radius) / smallest_radius);
  const int nearest = std::min(static_cast<int>(std::lround(row)), rows - 1);
  return Row(values_.data() + nearest * columns);
}

DiscProfile::Row DiscProfile::of_straight_edge() const {
  return Row(values_.data() + (rows - 1) * columns);
}

}  // namespace lodestar
