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

/// Orders the dots by groups; false when no two touch.
bool TouchingDots::find_groups(std::span<const Dot> dots) {
  const auto near = [&](std::size_t i, std::size_t j, double sigmas) {
    const auto [small, large] = std::minmax(dots[i].radius_px, dots[j].radius_px);
    // A dot's sigma is its radius over the root of 2. A glint beside it is not alike.
    return 2.0 * (dots[i].center_px - dots[j].center_px).squaredNorm() < square(sigmas * large) &&
           large <= options_.alike * small;
  };
  touching_.assign(dots.size(), 0);
  for (std::size_t i = 0; i < dots.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (near(i, j, options_.touching_sigmas)) touching_[i] = touching_[j] = 1;
  if (std::ranges::find(touching_, 1) == touching_.end()) return false;
  groups_.reset(dots.size());
  for (std::size_t i = 0; i < dots.size(); ++i) {
    if (touching_[i] == 0) continue;
    for (std::size_t j = 0; j < dots.size(); ++j)
      if (near(i, j, options_.fitted_along_sigmas)) groups_.join(i, j);
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
