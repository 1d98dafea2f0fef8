#include "drivers/simulation/dot_information.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/simulation/light_image.hpp"

namespace lodestar {
namespace {

constexpr double rounding_variance_gray2 = 1.0 / 12.0;

double gray_of(std::int16_t units) {
  return std::min(static_cast<double>(units) / LightImage::units_per_gray, 255.0);
}

/// Renders a small image of the disc alone.
LightImage painted(ProjectedDisc disc, const Vec2& center_px, const DiscImaging& imaging,
                   const DiscProfile& profile, int side) {
  LightImage image(side, side);
  const auto units =
      static_cast<std::int16_t>(std::lround(imaging.background_gray * LightImage::units_per_gray));
  for (int v = 0; v < side; ++v) std::fill_n(image.row(v), side, units);
  disc.center_px = center_px;
  image.paint(disc, Vec2::Zero(), imaging.gray, imaging.blur_sigma_px, profile);
  return image;
}

}  // namespace

Eigen::Matrix2d information_on_center(const ProjectedDisc& disc, const DiscImaging& imaging,
                                      const DiscProfile& profile) {
  constexpr double step_px = 0.125;
  const double reach_px = disc.half_size_px.maxCoeff() + DiscProfile::reach * imaging.blur_sigma_px;
  const int half = static_cast<int>(std::ceil(reach_px)) + 2;
  const int side = 2 * half + 1;
  const Vec2 fraction = disc.center_px - Vec2(std::round(disc.center_px.x()), std::round(disc.center_px.y()));
  const Vec2 center = Vec2::Constant(half) + fraction;
  const auto at = [&](double du, double dv) {
    return painted(disc, center + Vec2(du, dv), imaging, profile, side);
  };
  const LightImage here = at(0.0, 0.0);
  const LightImage left = at(-step_px, 0.0);
  const LightImage right = at(step_px, 0.0);
  const LightImage above = at(0.0, -step_px);
  const LightImage below = at(0.0, step_px);
  const double dark_variance = imaging.read_noise_gray * imaging.read_noise_gray + rounding_variance_gray2;
  const double variance_per_gray = imaging.shot_noise_gray_at_255 * imaging.shot_noise_gray_at_255 / 255.0;
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  for (int v = 0; v < side; ++v) {
    for (int u = 0; u < side; ++u) {
      const Vec2 slope = Vec2(gray_of(right.row(v)[u]) - gray_of(left.row(v)[u]),
                              gray_of(below.row(v)[u]) - gray_of(above.row(v)[u])) /
                         (2.0 * step_px);
      const double variance = dark_variance + variance_per_gray * gray_of(here.row(v)[u]);
      information += slope * slope.transpose() / variance;
    }
  }
  return information;
}

}  // namespace lodestar
