#include "localization/detection/light_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lodestar {
namespace {

constexpr double full_gray = 255.0;
constexpr double assumed_dots = 10.0;  // weight of the initial assumption
constexpr double remembered = 0.9995;  // forgetting factor per dot: a memory of some 2000 dots
constexpr int saturated_gray = 250;    // saturation clips the noise
constexpr double most_sigmas = 5.0;    // outlier gate

/// With the four pixels' middle at (u, v) from the dot's centre, a round shape f(d^2) adds 4 f'' u v to the
/// difference: less than two gray levels for a dot of contrast 200, radius 1.2 px and blur 0.5 px.
bool shape_shows(const Vec2& center_px, int u, int v) {
  constexpr double least_px2 = 0.004;
  return std::abs((center_px.x() - u - 0.5) * (center_px.y() - v - 0.5)) > least_px2;
}

}  // namespace

LightNoise::LightNoise(double shot_noise_gray_at_255)
    : variance_sum_(assumed_dots * square(shot_noise_gray_at_255)), light_sum_(assumed_dots * full_gray) {}

void LightNoise::add(const cv::Mat& gray, const Vec2& center_px, bool is_flat, double background_gray,
                     double dark_noise_gray) {
  const int u = static_cast<int>(center_px.x());
  const int v = static_cast<int>(center_px.y());
  if (u < 0 || v < 0 || u + 1 >= gray.cols || v + 1 >= gray.rows) return;
  if (!is_flat && shape_shows(center_px, u, v)) return;
  const auto* const above = gray.ptr<std::uint8_t>(v) + u;
  const auto* const below = gray.ptr<std::uint8_t>(v + 1) + u;
  if (std::max({above[0], above[1], below[0], below[1]}) >= saturated_gray) return;
  const double light = 0.25 * (above[0] + above[1] + below[0] + below[1]) - background_gray;
  if (!(light > 0.0)) return;
  const double variance = 0.25 * square(above[0] - above[1] - below[0] + below[1]);
  const double expected = square(dark_noise_gray) + light * variance_per_gray();
  if (variance > square(most_sigmas) * expected) return;
  variance_sum_ = remembered * variance_sum_ + variance - square(dark_noise_gray);
  light_sum_ = remembered * light_sum_ + light;
}

double LightNoise::variance_per_gray() const {
  return std::max(variance_sum_ / light_sum_, 0.0);
}

}  // namespace lodestar
