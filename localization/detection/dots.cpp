#include "localization/detection/dots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>

#include "localization/detection/wide_registers.hpp"

namespace lodestar {
namespace {

constexpr int smallest_part_px = 4;      // least size of each part after erosion
constexpr double round_as_a_dot = 1.25;  // aspect ratio: rounder areas are a single dot
constexpr double binary_sigma_px = 0.1;  // of the centroid of a dot's bright pixels

/// For non-negative values.
int rounded(double value) {
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

/// Order statistics of the gray values around a dot. Neighbouring dots may affect their upper half.
struct Surroundings {
  std::uint8_t second_darkest = 0;
  std::uint8_t third = 0;  ///< a third of the pixels are darker
  std::uint8_t median = 0;
};

/// Each statistic is the greatest sample with at most `rank` smaller ones, counted for all samples at once,
/// without sorting.
LODESTAR_WIDE_REGISTERS
Surroundings surroundings_of(const std::uint8_t* ring) {
  Samples samples;
  std::memcpy(&samples, ring, sizeof(samples));
  Samples smaller{};
  for (std::size_t i = 0; i < ring_samples; ++i) smaller -= static_cast<Samples>(samples > ring[i]);
  const auto of_rank = [&](std::uint8_t rank) { return greatest_of(smaller <= rank ? samples : Samples{}); };
  return {
      .second_darkest = of_rank(1), .third = of_rank(ring_samples / 3), .median = of_rank(ring_samples / 2)};
}

/// From a ring of 16 pixels around the dot, clamped to the frame.
Surroundings surroundings(const cv::Mat& gray, const Vec2& center_px, double reach_px) {
  const int u = rounded(center_px.x());
  const int v = rounded(center_px.y());
  const int full = rounded(reach_px);
  const int wide = rounded(0.924 * reach_px);  // at 22.5 degrees
  const int high = rounded(0.383 * reach_px);
  const int diagonal = rounded(0.707 * reach_px);
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

/// Gray value of the dot's centre: mean of the three brightest of its 3 x 3 pixels. Less noisy than the
/// brightest one, and unlike the mean of all nine not dimmed by the edge of a small dot. Nothing at the
/// frame's border.
std::optional<double> middle_gray(const cv::Mat& gray, const Vec2& center_px) {
  const int u = rounded(center_px.x());
  const int v = rounded(center_px.y());
  if (u < 1 || v < 1 || u + 1 >= gray.cols || v + 1 >= gray.rows) return std::nullopt;
  int first = 0;
  int second = 0;
  int third = 0;
  for (int j = v - 1; j <= v + 1; ++j) {
    const auto* const row = gray.ptr<std::uint8_t>(j);
    for (int i = u - 1; i <= u + 1; ++i) {
      const int value = row[i];
      third = std::max(third, std::min(second, value));
      second = std::max(second, std::min(first, value));
      first = std::max(first, value);
    }
  }
  return (first + second + third) / 3.0;
}

/// Background variance around a dot in excess of the frame's noise: joints and stains of the ceiling. They
/// bias its centre the same way in every frame.
double uneven_variance_gray2(const Surroundings& around, double dark) {
  constexpr double usual_spread = 1.32;  // sigmas from the second darkest to the median of 16 normal samples
  constexpr double clearly_more = 1.8;   // 16 samples of noise alone rarely spread this far
  const double sigma = (around.median - around.second_darkest) / usual_spread;
  return sigma > clearly_more * dark ? sigma * sigma - dark * dark : 0.0;
}

/// Combines dark noise, shot noise, the uneven background and `sampling_px`, which remains without any noise.
/// Errors of background pixels are correlated: they count as groups of two.
double sigma_of(const DiscCenter& center, double dark, double variance_per_gray, const Surroundings& around,
                double sampling_px) {
  constexpr double pixels_alike = 2.0;
  const double by_light = std::max(center.variance_per_light_px2, 0.0);
  const double dark_variance = dark * dark + pixels_alike * uneven_variance_gray2(around, dark);
  return std::sqrt(dark_variance * center.variance_per_variance_px2 + variance_per_gray * by_light +
                   sampling_px * sampling_px);
}

/// The gray-weighted centroid above the local background, within a disc that holds all of the dot's light,
/// gives its radius whatever the blur (light = pi r^2 contrast) and the start for the edge fit, which gives
/// its centre. The paper takes the centre of the binary dot, accurate to a few tenths of a pixel.
std::optional<Dot> measured_dot(const cv::Mat& gray, const BrightArea& area, const DotOptions& options,
                                double dark_noise_gray, double variance_per_gray) {
  Dot dot;
  dot.center_px = {area.mean_u_px, area.mean_v_px};
  const std::optional<double> middle = middle_gray(gray, dot.center_px);
  if (!middle) return std::nullopt;
  const double reach_px = std::sqrt(area.area_px / std::numbers::pi) + options.tail_px;
  const Surroundings around = surroundings(gray, dot.center_px, reach_px + 1.0);
  dot.background_gray = around.third;
  dot.contrast_gray = *middle - dot.background_gray;
  if (!(dot.contrast_gray > 0.0)) return std::nullopt;
  const std::optional<DiscLight> light = light_in_disc(gray, dot.center_px, reach_px, dot.background_gray);
  if (!light || !(light->mass > 0.0)) return std::nullopt;
  dot.radius_px = std::sqrt(light->mass / (std::numbers::pi * dot.contrast_gray));
  if (dot.radius_px < options.min_radius_px) return std::nullopt;
  if (options.by_binary_center) {
    dot.sigma_px = binary_sigma_px;
    return dot;
  }
  const std::optional<DiscCenter> center =
      center_by_edge(gray, light->center_px, dot.radius_px, dot.background_gray, options.edge);
  if (!center) return std::nullopt;
  dot.center_px = center->center_px;
  dot.sigma_px = sigma_of(*center, dark_noise_gray, variance_per_gray, around,
                          options.sampling_sigma_px2 / dot.radius_px);
  return dot;
}

/// A faint dot may exceed the threshold in several specks, each of which measures the whole dot; one is kept.
/// Areas are sorted from top to bottom, so only the last 64 dots are compared.
bool is_found_already(const Dot& dot, const BrightArea& area, std::span<const Dot> dots) {
  constexpr std::size_t far = 64;
  if (area.area_px > 0.6 * std::numbers::pi * dot.radius_px * dot.radius_px) return false;
  return std::ranges::any_of(dots.last(std::min(far, dots.size())), [&](const Dot& other) {
    return (other.center_px - dot.center_px).norm() < 0.5 * other.radius_px;
  });
}

}  // namespace

std::span<const Dot> DotFinder::find(const cv::Mat& gray) {
  if (options_.fixed_threshold) {
    thresholds_.set(gray.size(), static_cast<std::uint8_t>(std::clamp(*options_.fixed_threshold, 1, 255)));
  } else {
    thresholds_.find(gray, options_.threshold);
  }
  return find_by_thresholds(gray);
}

std::span<const Dot> DotFinder::find_within(std::span<const cv::Rect> parts, const cv::Mat& gray) {
  if (options_.fixed_threshold) return find(gray);
  thresholds_.find_within(parts, gray, options_.threshold);
  return find_by_thresholds(gray);
}

std::span<const Dot> DotFinder::find_by_thresholds(const cv::Mat& gray) {
  const BrightAreas& bright = area_finder_.find(gray, thresholds_);
  dots_.clear();
  for (std::size_t i = 0; i < bright.areas.size(); ++i) {
    const int area_px = bright.areas[i].area_px;
    if (area_px >= options_.min_area_px && area_px <= options_.max_area_px) append_dots_of_area(gray, i);
  }
  return dots_;
}

void DotFinder::append_dots_of_area(const cv::Mat& gray, std::size_t index) {
  const BrightAreas& bright = area_finder_.areas();
  const BrightArea& area = bright.areas[index];
  const bool may_be_several = area.aspect_ratio > round_as_a_dot && area.area_px >= 2 * smallest_part_px;
  const std::span<const BrightArea> parts =
      may_be_several ? parts_of(bright.runs_of(area)) : std::span<const BrightArea>{};
  if (parts.empty()) append_dot(gray, area, index);
  for (const BrightArea& part : parts) append_dot(gray, part, index);
}

/// Touching dots of one area, separated by erosion; none when it stays in one piece.
std::span<const BrightArea> DotFinder::parts_of(std::span<const Run> area) {
  const std::vector<BrightArea>& parts =
      part_connector_.connect(eroder_.erode(area, options_.erosion_px)).areas;
  const bool several = parts.size() > 1 && std::ranges::all_of(parts, [](const BrightArea& part) {
                         return part.area_px >= smallest_part_px;
                       });
  return several ? std::span<const BrightArea>(parts) : std::span<const BrightArea>{};
}

void DotFinder::append_dot(const cv::Mat& gray, const BrightArea& area, std::size_t index) {
  if (area.aspect_ratio > options_.max_aspect_ratio) return;
  const double dark_noise_gray = std::max(thresholds_.noise_gray(), options_.least_noise_gray);
  std::optional<Dot> dot =
      measured_dot(gray, area, options_, dark_noise_gray, light_noise_.variance_per_gray());
  if (!dot || is_found_already(*dot, area, dots_)) return;
  light_noise_.add(gray, dot->center_px, dot->radius_px >= options_.flat_radius_px, dot->background_gray,
                   dark_noise_gray);
  dot->area = index;
  dots_.push_back(*dot);
}

}  // namespace lodestar
