#include "localization/detection/touching_dots.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace lodestar {
namespace {

/// Where half of the dots lie on structure: is the background that they were fitted with darker than all of
/// those they were measured with alone? Then dark lines were taken for the background, and the ceiling
/// between them for the dots' light.
bool took_lines_for_background(double fitted_gray, std::span<const std::size_t> group,
                               std::span<const Dot> dots, double noise_gray) {
  constexpr double sigmas = 3.0;
  const auto on_structure = std::ranges::count_if(group, [&](std::size_t i) { return dots[i].on_structure; });
  return 2 * on_structure >= std::ssize(group) && std::ranges::all_of(group, [&](std::size_t i) {
           return fitted_gray < dots[i].background_gray - sigmas * noise_gray;
         });
}

/// Nearer to each other than so many sigmas of dots with this radius. A dot's sigma is its radius over the
/// root of 2.
bool within(double sigmas, double radius_px, const Dot& a, const Dot& b) {
  return 2.0 * (a.center_px - b.center_px).squaredNorm() < square(sigmas * radius_px);
}

}  // namespace

void TouchingDots::fit(const cv::Mat& gray, double noise_gray, double variance_per_gray,
                       std::vector<Dot>& dots) {
  if (!find_groups(dots)) return;
  dropped_.assign(dots.size(), false);
  for (auto begin = order_.begin(); begin != order_.end();) {
    const std::size_t number = numbers_[*begin];
    const auto end =
        std::find_if(begin, order_.end(), [&](std::size_t dot) { return numbers_[dot] != number; });
    if (end - begin > 1) fit_group(gray, noise_gray, variance_per_gray, {begin, end}, dots);
    begin = end;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < dots.size(); ++i)
    if (!dropped_[i]) dots[kept++] = dots[i];
  dots.resize(kept);
}

/// By the larger of two radii. A glint beside a dot is not alike.
bool TouchingDots::are_near(const Dot& a, const Dot& b, double sigmas) const {
  const auto [small, large] = std::minmax(a.radius_px, b.radius_px);
  return within(sigmas, large, a, b) && large <= options_.alike * small;
}

/// One dot of a marker over something bright, such as the pin of a sprinkler, looks larger, and too near to
/// its neighbours. So those that are near by the larger of their radii alone touch only where two others
/// about them do too: all of a marker are blurred alike.
bool TouchingDots::find_touching(std::span<const Dot> dots) {
  pairs_.clear();
  touching_.assign(dots.size(), 0);
  for (std::size_t i = 0; i < dots.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (are_near(dots[i], dots[j], options_.touching_sigmas)) pairs_.push_back({i, j});
  const auto is_apart_from = [&](const Pair& pair, const Pair& other) {
    return other.a != pair.a && other.a != pair.b && other.b != pair.a && other.b != pair.b &&
           are_near(dots[pair.a], dots[other.a], options_.fitted_along_sigmas);
  };
  for (const Pair& pair : pairs_) {
    const Dot& a = dots[pair.a];
    const Dot& b = dots[pair.b];
    const double small_px = std::min(a.radius_px, b.radius_px);
    if (within(options_.touching_sigmas, small_px, a, b) ||
        std::ranges::any_of(pairs_, [&](const Pair& other) { return is_apart_from(pair, other); }))
      touching_[pair.a] = touching_[pair.b] = 1;
  }
  return std::ranges::find(touching_, 1) != touching_.end();
}

/// Orders the dots by groups; false when no two touch.
bool TouchingDots::find_groups(std::span<const Dot> dots) {
  if (!find_touching(dots)) return false;
  groups_.reset(dots.size());
  for (std::size_t i = 0; i < dots.size(); ++i) {
    if (touching_[i] == 0) continue;
    for (std::size_t j = 0; j < dots.size(); ++j)
      if (are_near(dots[i], dots[j], options_.fitted_along_sigmas)) groups_.join(i, j);
  }
  groups_.number(numbers_);
  order_.resize(dots.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::ranges::sort(order_, {}, [&](std::size_t dot) { return std::pair(numbers_[dot], dot); });
  return true;
}

/// Blur hides the radius; as for a dot measured alone, it is that of a disc with the same light and height.
void TouchingDots::fit_group(const cv::Mat& gray, double noise_gray, double variance_per_gray,
                             std::span<const std::size_t> group, std::span<Dot> dots) {
  starts_px_.clear();
  double radius_px = 0.0;
  DotLight light{.noise_gray = noise_gray, .variance_per_gray = variance_per_gray};
  for (const std::size_t i : group) {
    starts_px_.push_back(dots[i].center_px);
    radius_px += dots[i].radius_px / static_cast<double>(group.size());
    light.background_gray += dots[i].background_gray / static_cast<double>(group.size());
  }
  light.width_px = radius_px / std::numbers::sqrt2;
  const FittedDots fitted = joint_fit_.fit(gray, starts_px_, light);
  if (fitted.dots.empty() || took_lines_for_background(fitted.background_gray, group, dots, noise_gray))
    return;
  for (const std::size_t i : group) dropped_[i] = true;
  for (const FittedDot& fit : fitted.dots) {
    Dot& dot = dots[group[fit.start]];
    dropped_[group[fit.start]] = false;
    dot.center_px = fit.center_px;
    dot.radius_px = std::numbers::sqrt2 * fitted.width_px;
    dot.sigma_px = std::hypot(fit.sigma_px, options_.sampling_sigma_px2 / dot.radius_px);
    dot.background_gray = fitted.background_gray;
    dot.contrast_gray = fit.height_gray;
  }
}

}  // namespace lodestar
