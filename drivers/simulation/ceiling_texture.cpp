#include "drivers/simulation/ceiling_texture.hpp"

#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "drivers/simulation/periodic_noise.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

enum TexturePurpose : std::uint64_t { stains = 21, tones_of_tiles, specks };

constexpr int side = CeilingTexture::side;
constexpr int tiles = 8;  // along a side
constexpr int tile = side / tiles;

/// Large soft blotches, enlarged from a coarse periodic grid.
cv::Mat1f draw_stains(Random random) {
  constexpr int coarse = 128;
  constexpr int scale = side / coarse;
  constexpr int border = 4;
  cv::Mat1f wide;
  cv::copyMakeBorder(smooth_noise(coarse, 6.0, 6.0, random), wide, border, border, border, border,
                     cv::BORDER_WRAP);
  cv::resize(wide, wide, {}, scale, scale, cv::INTER_CUBIC);
  return wide(cv::Rect(border * scale, border * scale, side, side)).clone();
}

/// A joint is a dark groove a few millimetres wide with soft flanks.
double joint_at(int texel) {
  const int from_joint = std::min(texel % tile, tile - texel % tile);
  constexpr double half_width = 1.3;
  return std::exp(-0.5 * std::pow(from_joint / half_width, 2));
}

}  // namespace

CeilingTexture::CeilingTexture(std::uint64_t seed) : texels_(static_cast<std::size_t>(side) * side) {
  const Random random(seed);
  const cv::Mat1f stain = draw_stains(random.stream(stains));
  const cv::Mat1f speck = smooth_noise(side, 1.2, 1.2, random.stream(specks));
  const cv::Mat1f tone = white_noise(tiles, random.stream(tones_of_tiles));
  std::array<double, side> joint{};
  for (int i = 0; i < side; ++i) joint[static_cast<std::size_t>(i)] = joint_at(i);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double groove = std::max(joint[static_cast<std::size_t>(x)], joint[static_cast<std::size_t>(y)]);
      const double fibre = 0.6 * stain(y, x) + 0.35 * speck(y, x) + 0.4 * tone(y / tile, x / tile);
      const double value = units_per_amplitude * ((1.0 - groove) * fibre - 1.8 * groove);
      texels_[static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x)] =
          cv::saturate_cast<std::int8_t>(value);
    }
  }
}

std::uint32_t CeilingTexture::wrapped(double from_corner_m) {
  const double periods = from_corner_m / period_m;
  return static_cast<std::uint32_t>((periods - std::floor(periods)) * 0x1.0p32);
}

}  // namespace lodestar
