#include "localization/local_threshold.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "localization/wide_registers.hpp"

namespace lodestar {
namespace {

constexpr int tile = LocalThresholds::tile_px;

struct Extremes {
  std::uint8_t darkest = 255;
  std::uint8_t brightest = 0;
};

/// As many pixels as a tile is wide.
using TileRow [[gnu::vector_size(tile)]] = std::uint8_t;

/// Of a tile whose whole width lies in the frame.
LODESTAR_WIDE_REGISTERS
Extremes extremes_of_tile(const std::uint8_t* pixels, std::size_t stride, int rows) {
  TileRow low;
  TileRow high;
  std::memcpy(&low, pixels, tile);
  high = low;
  for (int v = 1; v < rows; ++v) {
    pixels += stride;
    TileRow row;
    std::memcpy(&row, pixels, tile);
    low = row < low ? row : low;
    high = row > high ? row : high;
  }
  Extremes result;
  for (int u = 0; u < tile; ++u) {
    result.darkest = std::min(result.darkest, low[u]);
    result.brightest = std::max(result.brightest, high[u]);
  }
  return result;
}

Extremes extremes_of_part(const cv::Mat& gray, int top, int left, int rows) {
  Extremes result;
  for (int v = top; v < top + rows; ++v) {
    const auto* const pixels = gray.ptr<std::uint8_t>(v);
    for (int u = left; u < gray.cols; ++u) {
      result.darkest = std::min(result.darkest, pixels[u]);
      result.brightest = std::max(result.brightest, pixels[u]);
    }
  }
  return result;
}

/// Counted, not sorted: a frame has hundreds of tiles, but only 256 ranges.
int lower_quartile(const std::vector<std::uint8_t>& darkest, const std::vector<std::uint8_t>& brightest) {
  std::array<std::size_t, 256> count{};
  for (std::size_t i = 0; i < darkest.size(); ++i)
    ++count[static_cast<std::size_t>(brightest[i] - darkest[i])];
  std::size_t below = 0;
  for (std::size_t range = 0; range < count.size(); ++range) {
    below += count[range];
    if (4 * below >= darkest.size()) return static_cast<int>(range);
  }
  return 255;
}

}  // namespace

void LocalThresholds::resize(const cv::Size& frame) {
  rows_ = (frame.height + tile - 1) / tile;
  columns_ = (frame.width + tile - 1) / tile;
  thresholds_.resize(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_));
}

/// The difference of two pixels varies twice as much as one; what the ceiling shows drops out of it.
double LocalThresholds::noise_in_tiles(const cv::Mat& gray, int most_range) const {
  constexpr int most_tiles = 32;
  int tiles = 0;
  int pairs = 0;
  int squares = 0;
  for (std::size_t i = 0; i < thresholds_.size() && tiles < most_tiles; ++i) {
    if (brightest_[i] - darkest_[i] > most_range) continue;
    const int row = static_cast<int>(i) / columns_ * tile;
    const int column = static_cast<int>(i) % columns_ * tile;
    const auto* const pixels = gray.ptr<std::uint8_t>(std::min(row + tile / 2, gray.rows - 1)) + column;
    const int count = std::min(tile, gray.cols - column) - 1;
    for (int u = 0; u < count; ++u) {
      const int difference = pixels[u + 1] - pixels[u];
      squares += difference * difference;
    }
    pairs += count;
    ++tiles;
  }
  return pairs > 0 ? std::sqrt(0.5 * squares / pairs) : 0.0;
}

void LocalThresholds::set(const cv::Size& frame, std::uint8_t threshold) {
  resize(frame);
  std::ranges::fill(thresholds_, threshold);
}

void LocalThresholds::find(const cv::Mat& gray, const LocalThresholdOptions& options) {
  resize(gray.size());
  darkest_.resize(thresholds_.size());
  brightest_.resize(thresholds_.size());
  std::size_t i = 0;
  for (int top = 0; top < gray.rows; top += tile) {
    const int rows = std::min(tile, gray.rows - top);
    for (int left = 0; left < gray.cols; left += tile, ++i) {
      const Extremes extremes = left + tile <= gray.cols
                                    ? extremes_of_tile(gray.ptr<std::uint8_t>(top) + left, gray.step[0], rows)
                                    : extremes_of_part(gray, top, left, rows);
      darkest_[i] = extremes.darkest;
      brightest_[i] = extremes.brightest;
    }
  }
  const int quiet_range = lower_quartile(darkest_, brightest_);
  noise_gray_ = noise_in_tiles(gray, quiet_range);
  const double by_noise = options.min_range_to_noise * quiet_range;
  const int least =
      std::clamp(static_cast<int>(std::lround(by_noise)), options.min_range_gray, options.max_min_range_gray);
  for (std::size_t k = 0; k < thresholds_.size(); ++k) {
    const int range = brightest_[k] - darkest_[k];
    thresholds_[k] =
        range < least ? nothing_bright : static_cast<std::uint8_t>(darkest_[k] + (range + 1) / 2);
  }
}

}  // namespace lodestar
