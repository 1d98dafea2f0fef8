#include "localization/marker_areas.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "localization/disjoint_sets.hpp"
#include "maps/marker.hpp"

namespace lodestar {
namespace {

constexpr double pitch_over_radius = marker_pitch_m / marker_dot_radius_m;

double join_distance_px(double radius_px, const MarkerAreaOptions& options) {
  return options.dilation_px > 0.0 ? options.dilation_px
                                   : options.join_pitches * pitch_over_radius * radius_px;
}

bool joins(const Dot& a, const Dot& b, const MarkerAreaOptions& options) {
  const auto [small, large] = std::minmax(a.radius_px, b.radius_px);
  const double mean_radius_px = 0.5 * (small + large);
  return large <= options.max_size_ratio * small &&
         (a.center_px - b.center_px).norm() < join_distance_px(mean_radius_px, options);
}

/// By rows of the image, so that only dots of nearby rows have to be compared.
std::vector<std::size_t> from_top_to_bottom(std::span<const Dot> dots) {
  std::vector<std::size_t> order(dots.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return dots[i].center_px.y(); });
  return order;
}

}  // namespace

std::vector<std::vector<std::size_t>> dilated_areas(std::span<const Dot> dots,
                                                    const MarkerAreaOptions& options) {
  DisjointSets sets(dots.size());
  const std::vector<std::size_t> order = from_top_to_bottom(dots);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Dot& dot = dots[order[i]];
    const double reach_px = join_distance_px(options.max_size_ratio * dot.radius_px, options);
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const Dot& other = dots[order[j]];
      if (other.center_px.y() - dot.center_px.y() > reach_px) break;
      if (joins(dot, other, options)) sets.join(order[i], order[j]);
    }
  }
  std::vector<std::vector<std::size_t>> areas;
  std::vector<std::size_t> number;
  sets.number(number);
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] == areas.size()) areas.emplace_back();
    areas[number[i]].push_back(i);
  }
  return areas;
}

}  // namespace lodestar
