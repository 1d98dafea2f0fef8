#include "localization/detection/surroundings.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "localization/detection/wide_registers.hpp"

namespace lodestar {
namespace {

/// For non-negative values.
int nearest_pixel(double value) {
  return static_cast<int>(value + 0.5);
}

constexpr std::size_t ring_samples = 16;
using Samples [[gnu::vector_size(ring_samples)]] = std::uint8_t;

[[gnu::always_inline]] inline std::uint8_t greatest_of(Samples v) {
  const auto greatest = [](const Samples& a, const Samples& b) { return a > b ? a : b; };
  v = greatest(v, __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7));
  v = greatest(v, __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11));
  v = greatest(v, __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13));
  return std::max(v[0], v[1]);
}

/// Each statistic is the greatest sample with at most `rank` smaller ones, counted for all samples at once,
/// without sorting.
LODESTAR_WIDE_REGISTERS
Surroundings surroundings_of(const std::uint8_t* ring) {
  Samples samples;
  std::memcpy(&samples, ring, sizeof(samples));
  Samples smaller{};
  for (std::size_t i = 0; i < ring_samples; ++i) smaller -= static_cast<Samples>(samples > ring[i]);
  const auto of_rank = [&](std::uint8_t rank) { return greatest_of(smaller <= rank ? samples : Samples{}); };
  return {.second_darkest = of_rank(1),
          .third = of_rank(ring_samples / 3),
          .median = of_rank(ring_samples / 2),
          .second_brightest = of_rank(ring_samples - 2)};
}

}  // namespace

Surroundings surroundings(const cv::Mat& gray, const Vec2& center_px, double reach_px) {
  const int u = nearest_pixel(center_px.x());
  const int v = nearest_pixel(center_px.y());
  const int full = nearest_pixel(reach_px);
  const int wide = nearest_pixel(0.924 * reach_px);  // at 22.5 degrees
  const int high = nearest_pixel(0.383 * reach_px);
  const int diagonal = nearest_pixel(0.707 * reach_px);
  const std::array<std::array<int, 2>, ring_samples / 4> quarter{
      {{full, 0}, {wide, high}, {diagonal, diagonal}, {high, wide}}};
  const bool inside = u >= full && v >= full && u + full < gray.cols && v + full < gray.rows;
  const auto at = [&](int column, int row) {
    return inside ? gray.ptr<std::uint8_t>(row)[column]
                  : gray.ptr<std::uint8_t>(
                        std::clamp(row, 0, gray.rows - 1))[std::clamp(column, 0, gray.cols - 1)];
  };
  std::array<std::uint8_t, ring_samples> ring;
  for (std::size_t i = 0; i < quarter.size(); ++i) {
    const auto [du, dv] = quarter[i];
    ring[4 * i] = at(u + du, v + dv);
    ring[4 * i + 1] = at(u - dv, v + du);
    ring[4 * i + 2] = at(u - du, v - dv);
    ring[4 * i + 3] = at(u + dv, v - du);
  }
  return surroundings_of(ring.data());
}

}  // namespace lodestar
