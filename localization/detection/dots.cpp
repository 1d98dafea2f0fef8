#include "localization/detection/dots.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "localization/detection/surroundings.hpp"

namespace lodestar {
namespace {

constexpr int smallest_part_px = 4;      // least size of each part after erosion
constexpr double round_as_a_dot = 1.25;  // aspect ratio: rounder areas are a single dot
constexpr double round_part = 1.5;       // of a part that erosion leaves; others are several dots still
constexpr double binary_sigma_px = 0.1;  // of the centroid of a dot's bright pixels
constexpr double usual_spread = 1.32;    // sigmas from the second darkest to the median of 16 normal samples
constexpr double clearly_more = 1.8;     // 16 samples of noise alone rarely spread this far

/// For non-negative values.
int rounded(double value) {
  return static_cast<int>(value + 0.5);
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

/// What noise and surroundings say about a dot's accuracy.
struct DotNoise {
  double dark_gray = 0.0;
  double variance_per_gray = 0.0;
};

/// The gray-weighted centroid above the local background, within a disc that holds all of the dot's light,
/// gives its radius whatever the blur (light = pi r^2 contrast) and the start for the edge fit, which gives
/// its centre. The paper takes the centre of the binary dot, accurate to a few tenths of a pixel.
/// `dot` has its centre, background and contrast.
std::optional<Dot> measured_on(const cv::Mat& gray, Dot dot, double reach_px, const Surroundings& around,
                               const DotOptions& options, const DotNoise& noise) {
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
  dot.sigma_px = sigma_of(*center, noise.dark_gray, noise.variance_per_gray, around,
                          options.sampling_sigma_px2 / dot.radius_px);
  return dot;
}

/// Is part of the ceiling around a dot so much darker that it shows in the dot's light?
bool has_darker_part(const Surroundings& around, double contrast_gray, const DotOptions& options) {
  return around.median - around.second_darkest > options.structure * contrast_gray;
}

/// The same where lines may fill most of the ring: it varies by twice as much, and more than by noise, but
/// not by so much as where another dot shines into it.
bool shows_lines(const Surroundings& around, double contrast_gray, double dark, const DotOptions& options) {
  const double range = around.second_brightest - around.second_darkest;
  return range > 2.0 * options.structure * contrast_gray && range < options.most_structure * contrast_gray &&
         range > clearly_more * 2.0 * usual_spread * dark;
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
  if (!options_.by_binary_center)
    touching_dots_.fit(gray, noise_gray(), light_noise_.variance_per_gray(), dots_);
  return dots_;
}

void DotFinder::append_dots_of_area(const cv::Mat& gray, std::size_t index) {
  const BrightAreas& bright = area_finder_.areas();
  const BrightArea& area = bright.areas[index];
  const bool may_be_several = area.aspect_ratio > round_as_a_dot && area.area_px >= 2 * smallest_part_px;
  const std::span<const BrightArea> parts =
      may_be_several ? parts_of(bright.runs_of(area)) : std::span<const BrightArea>{};
  const bool parts_are_round = !parts.empty() && std::ranges::all_of(parts, [](const BrightArea& part) {
    return part.aspect_ratio <= round_part;
  });
  if (may_be_several && !parts_are_round && !options_.by_binary_center &&
      append_peaks(gray, area, index, parts.size()))
    return;
  if (parts.empty() && !append_dot(gray, area, index) && !may_be_several &&
      area.area_px >= 4 * smallest_part_px && !options_.by_binary_center) {
    append_peaks(gray, area, index, 1);  // four dots around a valley are as round as one
  }
  for (const BrightArea& part : parts) append_dot(gray, part, index);
}

/// Dots that erosion does not separate, by their peaks. What is known of them is a start for the joint fit.
/// False when there are no more than the parts that erosion leaves.
bool DotFinder::append_peaks(const cv::Mat& gray, const BrightArea& area, std::size_t index,
                             std::size_t parts) {
  const std::span<const Run> runs = area_finder_.areas().runs_of(area);
  const int u = rounded(area.mean_u_px);
  const int v = rounded(area.mean_v_px);
  const double background_gray = thresholds_.background_gray(u, v);
  const std::span<const Vec2> peaks = peak_finder_.find(gray, runs, background_gray, noise_gray());
  if (peaks.size() <= std::max(parts, std::size_t{1})) return false;
  const double area_of_each_px2 = area.area_px / static_cast<double>(peaks.size());
  for (const Vec2& peak : peaks) {
    const std::optional<double> middle = middle_gray(gray, peak);
    if (!middle) continue;
    dots_.push_back({.center_px = peak,
                     .sigma_px = binary_sigma_px,
                     .radius_px = std::sqrt(area_of_each_px2 / std::numbers::pi),
                     .background_gray = background_gray,
                     .contrast_gray = *middle - background_gray,
                     .area = index});
  }
  return true;
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

/// Measured on the frame; on the evened ceiling where structure shows around the dot.
std::optional<Dot> DotFinder::measured_dot(const cv::Mat& gray, const BrightArea& area,
                                           double dark_noise_gray) {
  Dot dot;
  dot.center_px = {area.mean_u_px, area.mean_v_px};
  const std::optional<double> middle = middle_gray(gray, dot.center_px);
  if (!middle) return std::nullopt;
  const double reach_px = std::sqrt(area.area_px / std::numbers::pi) + options_.tail_px;
  const double ring_px = reach_px + 1.0;
  const Surroundings around = surroundings(gray, dot.center_px, ring_px);
  dot.background_gray = around.third;
  dot.contrast_gray = *middle - dot.background_gray;
  if (!(dot.contrast_gray > options_.least_contrast * thresholds_.least_range_gray())) return std::nullopt;
  const DotNoise noise{dark_noise_gray, light_noise_.variance_per_gray()};
  const bool tile_is_structured =
      thresholds_.has_structure(rounded(dot.center_px.x()), rounded(dot.center_px.y()));
  const bool structured = (tile_is_structured && has_darker_part(around, dot.contrast_gray, options_)) ||
                          shows_lines(around, dot.contrast_gray, dark_noise_gray, options_);
  if (options_.by_binary_center || !structured ||
      !even_ceiling_.copy(gray, dot.center_px, ring_px, dark_noise_gray,
                          options_.least_light * dot.contrast_gray)) {
    return measured_on(gray, dot, reach_px, around, options_, noise);
  }
  dot.center_px = even_ceiling_.center_px();
  dot.background_gray = even_ceiling_.background_gray();
  dot.contrast_gray = *middle - dot.background_gray;
  if (!(dot.contrast_gray > options_.least_contrast * thresholds_.least_range_gray())) return std::nullopt;
  std::optional<Dot> measured = measured_on(even_ceiling_.gray(), dot, reach_px, around, options_, noise);
  if (!measured) return std::nullopt;
  measured->center_px -= even_ceiling_.shift_px();
  measured->on_structure = true;
  return measured;
}

/// False when the area is no dot.
bool DotFinder::append_dot(const cv::Mat& gray, const BrightArea& area, std::size_t index) {
  if (area.aspect_ratio > options_.max_aspect_ratio) return false;
  const double dark_noise_gray = noise_gray();
  std::optional<Dot> dot = measured_dot(gray, area, dark_noise_gray);
  if (!dot) return false;
  if (is_found_already(*dot, area, dots_)) return true;
  light_noise_.add(gray, dot->center_px, dot->radius_px >= options_.flat_radius_px, dot->background_gray,
                   dark_noise_gray);
  dot->area = index;
  dots_.push_back(*dot);
  return true;
}

}  // namespace lodestar
