#include "localization/detection/local_threshold.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <optional>

#include "localization/detection/frame_noise.hpp"
#include "localization/detection/sixteen_pixels.hpp"
#include "localization/detection/wide_registers.hpp"

namespace lodestar {
namespace {

constexpr int tile = LocalThresholds::tile_px;

struct Extremes {
  std::uint8_t darkest = 255;
  std::uint8_t brightest = 0;
  [[nodiscard]] int range() const { return brightest - darkest; }
};

/// One row of a tile.
using TileRow [[gnu::vector_size(tile)]] = std::uint8_t;

SixteenPixels least_of_halves(const TileRow& row) {
  static_assert(sizeof(TileRow) == 2 * sizeof(SixteenPixels));
  std::array<SixteenPixels, 2> halves;
  std::memcpy(halves.data(), &row, sizeof(row));
  return least_of(halves[0], halves[1]);
}

/// The minimum of each of the four. Every step halves the number of lanes, of all four at once.
std::array<std::uint8_t, 4> least_of_four(const SixteenPixels& a, const SixteenPixels& b,
                                          const SixteenPixels& c, const SixteenPixels& d) {
  const auto halved = [](const SixteenPixels& x, const SixteenPixels& y) {
    return least_of(
        __builtin_shufflevector(x, y, 0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23),
        __builtin_shufflevector(x, y, 8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 26, 27, 28, 29, 30, 31));
  };
  const SixteenPixels ab = halved(a, b);
  const SixteenPixels cd = halved(c, d);
  SixteenPixels v =
      least_of(__builtin_shufflevector(ab, cd, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27),
               __builtin_shufflevector(ab, cd, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31));
  v = least_of(v, __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13));
  v = least_of(v, __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14));
  return {v[0], v[4], v[8], v[12]};
}

/// Minimum and maximum of each column of a tile.
struct Columns {
  TileRow low;
  TileRow high;
};

[[gnu::always_inline]] inline void start(Columns& columns, const std::uint8_t* pixels) {
  std::memcpy(&columns.low, pixels, tile);
  columns.high = columns.low;
}

[[gnu::always_inline]] inline void take(Columns& columns, const std::uint8_t* pixels) {
  TileRow row;
  std::memcpy(&row, pixels, tile);
  columns.low = row < columns.low ? row : columns.low;
  columns.high = row > columns.high ? row : columns.high;
}

/// Extremes of neighbouring full-width tiles, from every `step`-th row of pixels. Two tiles at a time share a
/// cache line. The maximum is computed as the minimum of the complements.
LODESTAR_WIDE_REGISTERS
void find_extremes(const std::uint8_t* pixels, std::size_t stride, int rows, int step,
                   std::span<Extremes> tiles) {
  const std::size_t step_bytes = static_cast<std::size_t>(step) * stride;
  for (std::size_t i = 0; i < tiles.size(); i += 2, pixels += 2 * static_cast<std::ptrdiff_t>(tile)) {
    const bool is_pair = i + 1 < tiles.size();
    const std::uint8_t* place = pixels;
    const std::ptrdiff_t next = is_pair ? tile : 0;
    Columns a;
    Columns b;
    start(a, place);
    start(b, place + next);
    for (int v = step; v < rows; v += step) {
      place += step_bytes;
      take(a, place);
      take(b, place + next);
    }
    const std::array<std::uint8_t, 4> least = least_of_four(least_of_halves(a.low), least_of_halves(~a.high),
                                                            least_of_halves(b.low), least_of_halves(~b.high));
    tiles[i] = {least[0], static_cast<std::uint8_t>(~least[1])};
    if (is_pair) tiles[i + 1] = {least[2], static_cast<std::uint8_t>(~least[3])};
  }
}

/// Extremes of a part of a tile; a part at least half a tile wide is covered by two halves that may overlap.
Extremes extremes_of_part(const cv::Mat& gray, const cv::Rect& part) {
  constexpr int half = sizeof(SixteenPixels);
  if (part.width >= half && part.height > 0) {
    SixteenPixels low = ~SixteenPixels{};
    SixteenPixels high_complement = low;
    for (int v = part.y; v < part.br().y; ++v) {
      const auto* const row = gray.ptr<std::uint8_t>(v);
      for (const int u : {part.x, part.br().x - half}) {
        const SixteenPixels pixels = sixteen_at(row + u);
        low = least_of(low, pixels);
        high_complement = least_of(high_complement, ~pixels);
      }
    }
    const std::array<std::uint8_t, 4> least = least_of_four(low, high_complement, low, high_complement);
    return {least[0], static_cast<std::uint8_t>(~least[1])};
  }
  Extremes result;
  for (int v = part.y; v < part.br().y; ++v) {
    const auto* const pixels = gray.ptr<std::uint8_t>(v);
    for (int u = part.x; u < part.br().x; ++u) {
      result.darkest = std::min(result.darkest, pixels[u]);
      result.brightest = std::max(result.brightest, pixels[u]);
    }
  }
  return result;
}

/// The background of a tile on which dots are to be told from the ceiling.
///
/// Usually its darkest pixel. But where half of the pixels are clearly brighter than that, more than dots
/// fill (with all 16 cells full, 20 % and their blurred edges), the dark ones are joints, grooves or slots of
/// a brighter ceiling. The brighter level is the background then: the 70th percentile, as dots are above it.
/// Nothing when nothing rises above that level, so that there are no dots, unless it is that of a lamp, which
/// saturates, and beside which there may be dots on the dark remainder.
std::optional<int> background_of(const cv::Mat& gray, const cv::Rect& part, const Extremes& extremes,
                                 int least_range) {
  constexpr std::array eighths{1, 3, 5, 7};  // of the tile's height: rows sampled
  constexpr double clearly_brighter = 0.25;  // share of the range
  constexpr double most_by_dots = 0.5;       // share of the pixels
  constexpr double level_share = 0.7;
  constexpr int saturated_gray = 235;
  const int quarter = extremes.darkest + static_cast<int>(clearly_brighter * extremes.range());
  std::array<std::uint8_t, eighths.size() * tile> samples{};
  std::size_t count = 0;
  std::size_t brighter = 0;
  for (const int eighth : eighths) {
    const auto* const pixels = gray.ptr<std::uint8_t>(part.y + part.height * eighth / 8) + part.x;
    for (int u = 0; u < part.width; ++u) {
      samples[count++] = pixels[u];
      brighter += pixels[u] > quarter ? 1 : 0;
    }
  }
  if (static_cast<double>(brighter) < most_by_dots * static_cast<double>(count)) return extremes.darkest;
  auto* const level = samples.data() + static_cast<std::size_t>(level_share * static_cast<double>(count));
  std::nth_element(samples.data(), level, samples.data() + count);
  if (extremes.brightest - *level >= least_range) return *level;
  if (extremes.brightest >= saturated_gray) return extremes.darkest;
  return std::nullopt;
}

const std::uint8_t* pixels_of(const cv::Mat& gray, int row, int column) {
  return gray.ptr<std::uint8_t>(row * tile) + static_cast<std::ptrdiff_t>(column) * tile;
}

}  // namespace

void LocalThresholds::set(const cv::Size& frame, std::uint8_t threshold) {
  rows_ = (frame.height + tile - 1) / tile;
  columns_ = (frame.width + tile - 1) / tile;
  thresholds_.assign(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_), threshold);
}

void LocalThresholds::find(const cv::Mat& gray, const LocalThresholdOptions& options) {
  const cv::Rect whole(0, 0, gray.cols, gray.rows);
  find_within(std::span(&whole, 1), gray, options);
}

void LocalThresholds::find_within(std::span<const cv::Rect> parts, const cv::Mat& gray,
                                  const LocalThresholdOptions& options) {
  set(gray.size(), nothing_bright);
  ranges_.assign(thresholds_.size(), 0);
  backgrounds_.assign(thresholds_.size(), 0);
  structured_.assign(thresholds_.size(), 0);
  noise_gray_ = noise_of(gray);
  least_range_ = std::max(options.min_range_gray,
                          static_cast<int>(std::lround(options.min_range_to_noise * noise_gray_)));
  bright_tiles_.clear();
  for (const cv::Rect& part : parts) {
    const cv::Rect inside = part & cv::Rect(0, 0, gray.cols, gray.rows);
    if (inside.empty()) continue;
    const int first = inside.x / tile;
    const int last = (inside.br().x - 1) / tile;
    for (int row = inside.y / tile; row <= (inside.br().y - 1) / tile; ++row)
      examine_tiles(gray, row, first, last + 1);
  }
  for (const cv::Point& at : bright_tiles_) correct_for_neighbours(gray, at);
}

/// Every other row decides whether the whole tile is read: half a pixel above or below its centre even the
/// smallest dot has more than this share of its light. Noise adds to the range of these rows as to that of
/// all: the darkest of 512 pixels is rarely less than 2.5 sigmas below their mean.
void LocalThresholds::examine_tiles(const cv::Mat& gray, int row, int first, int end) {
  constexpr double share_between_rows = 0.65;
  constexpr std::size_t at_once = 64;
  constexpr double sigmas_below_mean = 2.5;
  const double noise = sigmas_below_mean * noise_gray_;
  const int least_glance = static_cast<int>(noise + share_between_rows * (least_range_ - noise));
  const int rows = std::min(tile, gray.rows - row * tile);
  const int whole_end = std::min(end, gray.cols / tile);
  std::array<Extremes, at_once> glances;
  for (int column = first; column < whole_end; column += static_cast<int>(at_once)) {
    const auto count = std::min(at_once, static_cast<std::size_t>(whole_end - column));
    find_extremes(pixels_of(gray, row, column), gray.step[0], rows, 2, std::span(glances).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      if (glances[i].range() < least_glance) continue;
      Extremes extremes;
      const int here = column + static_cast<int>(i);
      find_extremes(pixels_of(gray, row, here), gray.step[0], rows, 1, std::span(&extremes, 1));
      set_tile(gray, {here, row}, extremes.darkest, extremes.brightest);
    }
  }
  if (whole_end == end) return;
  const int left = whole_end * tile;
  const Extremes extremes = extremes_of_part(gray, {left, row * tile, gray.cols - left, rows});
  set_tile(gray, {whole_end, row}, extremes.darkest, extremes.brightest);
}

void LocalThresholds::set_tile(const cv::Mat& gray, const cv::Point& at, int darkest, int brightest) {
  const std::size_t i = index(at);
  if (brightest - darkest < least_range_ || thresholds_[i] != nothing_bright) return;
  const cv::Rect part = cv::Rect(at.x * tile, at.y * tile, tile, tile) & cv::Rect(0, 0, gray.cols, gray.rows);
  const std::optional<int> background = background_of(
      gray, part, {static_cast<std::uint8_t>(darkest), static_cast<std::uint8_t>(brightest)}, least_range_);
  structured_[i] = !background || *background > darkest ? 1 : 0;
  if (!background) return;
  const int range = brightest - *background;
  backgrounds_[i] = static_cast<std::uint8_t>(*background);
  ranges_[i] = static_cast<std::uint8_t>(range);
  thresholds_[i] = static_cast<std::uint8_t>(*background + (range + 1) / 2);
  bright_tiles_.push_back(at);
}

/// A tile may hold only the blurred edge of a dot or lamp in a neighbouring tile. The neighbour's threshold
/// then decides where it ends.
void LocalThresholds::correct_for_neighbours(const cv::Mat& gray, const cv::Point& at) {
  constexpr double clearly_less = 0.75;
  constexpr int edge_px = 3;
  const cv::Rect around = cv::Rect(at.x - 1, at.y - 1, 3, 3) & cv::Rect(0, 0, columns_, rows_);
  std::size_t strongest = index(at);
  for (int row = around.y; row < around.br().y; ++row) {
    for (int column = around.x; column < around.br().x; ++column) {
      const std::size_t i = index({column, row});
      if (ranges_[i] > ranges_[strongest]) strongest = i;
    }
  }
  if (!(ranges_[index(at)] < clearly_less * ranges_[strongest])) return;
  const cv::Rect inner =
      cv::Rect(at.x * tile + edge_px, at.y * tile + edge_px, tile - 2 * edge_px, tile - 2 * edge_px) &
      cv::Rect(0, 0, gray.cols, gray.rows);
  const Extremes of_inner = extremes_of_part(gray, inner);
  if (of_inner.brightest - std::max(of_inner.darkest, backgrounds_[index(at)]) < least_range_)
    thresholds_[index(at)] = std::max(thresholds_[index(at)], thresholds_[strongest]);
}

}  // namespace lodestar
