#include "localization/detection/marker_areas.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

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
  const double reach_px = join_distance_px(mean_radius_px, options);
  return large <= options.max_size_ratio * small &&
         (a.center_px - b.center_px).squaredNorm() < reach_px * reach_px;
}

}  // namespace

std::size_t MarkerAreaFinder::find(std::span<const Dot> dots) {
  join(dots);
  sets_.number(numbers_);
  const std::size_t areas = numbers_.empty() ? 0 : *std::ranges::max_element(numbers_) + 1;
  // Start of each area, advanced to its end as its dots are written.
  ends_.assign(areas + 1, 0);
  for (const std::size_t number : numbers_) ++ends_[number + 1];
  std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
  dots_.resize(dots.size());
  for (std::size_t i = 0; i < dots.size(); ++i) dots_[ends_[numbers_[i]]++] = dots[i];
  return areas;
}

std::span<const Dot> MarkerAreaFinder::dots_of(std::size_t area) const {
  const std::size_t first = area > 0 ? ends_[area - 1] : 0;
  return std::span(dots_).subspan(first, ends_[area] - first);
}

/// Sorts by image row, so that only dots of nearby rows are compared.
void MarkerAreaFinder::join(std::span<const Dot> dots) {
  sets_.reset(dots.size());
  order_.resize(dots.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::ranges::sort(order_, {}, [&](std::size_t i) { return dots[i].center_px.y(); });
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const Dot& dot = dots[order_[i]];
    const double reach_px = join_distance_px(options_.max_size_ratio * dot.radius_px, options_);
    for (std::size_t j = i + 1; j < order_.size(); ++j) {
      const Dot& other = dots[order_[j]];
      const Vec2 apart = other.center_px - dot.center_px;
      if (apart.y() > reach_px) break;
      if (std::abs(apart.x()) > reach_px) continue;
      if (joins(dot, other, options_)) sets_.join(order_[i], order_[j]);
    }
  }
}

}  // namespace lodestar
