#include "localization/detection/cell_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>

#include "localization/detection/ceiling_level.hpp"
#include "localization/detection/dark_line.hpp"
#include "localization/detection/disc_light.hpp"
#include "localization/detection/even_ceiling.hpp"

namespace lodestar {
namespace {

double mean_of(std::span<const Dot> dots, double Dot::* value) {
  double sum = 0.0;
  for (const Dot& dot : dots) sum += dot.*value;
  return sum / static_cast<double>(dots.size());
}

/// A marker's dots as they are seen, to which the light of a cell is compared.
class DotsSeen {
 public:
  DotsSeen(std::span<const Dot> dots, double noise_gray, const CellEvidenceOptions& options)
      : options_(options),
        dots_(dots),
        noise_gray_(noise_gray),
        radius_px_(mean_of(dots, &Dot::radius_px)),
        background_gray_(mean_of(dots, &Dot::background_gray)),
        contrast_gray_(mean_of(dots, &Dot::contrast_gray)) {}

  /// Log odds of a dot in a place without one of the marker's dots: not positive, and 0 when undecided.
  [[nodiscard]] double odds_at(const cv::Mat& gray, const Vec2& place_px) {
    const std::optional<DiscLight> seen = light_in_disc(gray, place_px, radius_px_, background_gray_);
    if (!seen) return 0.0;
    // Darker than the film is as implausible as brighter: an occluder is in front of it.
    const double odds = odds_of(seen->mass - light_of_neighbours(place_px));
    if (odds == -options_.sure) return odds;
    return std::min(odds, odds_on_structure(gray, place_px));
  }

 private:
  [[nodiscard]] double odds_of(double mass) const {
    const double light_of_a_dot = std::numbers::pi * radius_px_ * radius_px_ * contrast_gray_;
    const double slope = options_.sure / (options_.unsure_contrast - options_.dark_contrast);
    const double unsure =
        options_.unsure_contrast + options_.small_dot_contrast_px2 / (radius_px_ * radius_px_);
    return std::clamp((std::abs(mass) / light_of_a_dot - unsure) * slope, -options_.sure, 0.0);
  }

  /// The same where the ceiling is not even. Dark lines hide no dot when the ceiling is seen between them,
  /// and a gradient is none: what counts is the light above the evened ceiling, provided that enough of the
  /// place is at the ceiling's level.
  [[nodiscard]] double odds_on_structure(const cv::Mat& gray, const Vec2& place_px) {
    if (!level_) level_.emplace(dots_);
    const double tolerance_gray =
        std::max(options_.level_noise_sigmas * noise_gray_, options_.dark_contrast * contrast_gray_) +
        options_.level_spreads * level_->spread_gray();
    const double in_view = share_at_level(gray, place_px, options_.inner_radii * radius_px_,
                                          level_->at(place_px), tolerance_gray);
    if (in_view < options_.least_in_view && !shows_line_of_ceiling(gray, place_px, tolerance_gray))
      return 0.0;
    if (!even_ceiling_) even_ceiling_.emplace();
    if (!even_ceiling_->copy(gray, place_px, options_.ring_radii * radius_px_, noise_gray_,
                             -options_.level_noise_sigmas * noise_gray_))
      return 0.0;
    const std::optional<DiscLight> light = light_in_disc(even_ceiling_->gray(), even_ceiling_->center_px(),
                                                         radius_px_, even_ceiling_->background_gray());
    return light ? odds_of(light->mass - light_of_neighbours(place_px)) : 0.0;
  }

  /// As dark as a line through it, as there are lines behind the marker's dots: what is dark is the ceiling.
  [[nodiscard]] bool shows_line_of_ceiling(const cv::Mat& gray, const Vec2& place_px, double tolerance_gray) {
    if (!shows_dark_line(gray, disc_at(place_px, tolerance_gray))) return false;
    if (!dots_on_lines_) {
      dots_on_lines_ = std::ranges::count_if(dots_, [&](const Dot& dot) {
        return is_before_dark_line(gray, disc_at(dot.center_px, tolerance_gray));
      });
    }
    return *dots_on_lines_ >= options_.least_dots_on_lines;
  }

  [[nodiscard]] DiscOnCeiling disc_at(const Vec2& center_px, double tolerance_gray) const {
    return {.center_px = center_px,
            .side_px = options_.side_radii * radius_px_,
            .ring_px = options_.line_radii * radius_px_,
            .level_gray = level_->at(center_px),
            .tolerance_gray = tolerance_gray};
  }

  /// Light of the marker's dots within the disc about a place, where blur brings it: of Gaussians with the
  /// light of discs of the same radius and contrast. Integrated over the disc by seven points (Stroud 1971,
  /// S2 3-2: exact for cubic polynomials).
  [[nodiscard]] double light_of_neighbours(const Vec2& place_px) const {
    const double width_px = radius_px_ / std::numbers::sqrt2;
    const double area_px2 = std::numbers::pi * radius_px_ * radius_px_;
    const double ring_px = radius_px_ * std::sqrt(2.0 / 3.0);
    double light = 0.0;
    for (const Dot& dot : dots_) {
      const Vec2 off = place_px - dot.center_px;
      if (off.squaredNorm() > square(options_.neighbour_sigmas * width_px)) continue;
      const auto at = [&](const Vec2& place) {
        return std::exp(-0.5 * place.squaredNorm() / square(width_px));
      };
      double sum = 2.0 * at(off);
      for (int i = 0; i < 6; ++i) {
        const double angle = std::numbers::pi / 3.0 * i;
        sum += at(off + ring_px * Vec2(std::cos(angle), std::sin(angle)));
      }
      light += area_px2 * contrast_gray_ * sum / 8.0;
    }
    return light;
  }

  const CellEvidenceOptions& options_;
  std::span<const Dot> dots_;
  double noise_gray_;
  double radius_px_;
  double background_gray_;
  double contrast_gray_;
  std::optional<CeilingLevel> level_;
  std::optional<std::ptrdiff_t> dots_on_lines_;  ///< dots with a dark line behind them
  std::optional<EvenCeiling> even_ceiling_;      ///< made when needed: it is large
};

}  // namespace

CellEvidence evidence_of_cells(const cv::Mat& gray, const MarkerGrid& grid,
                               std::span<const MarkerDot> in_cells, std::span<const Dot> dots,
                               double noise_gray, const CellEvidenceOptions& options) {
  DotsSeen seen(dots, noise_gray, options);
  CellEvidence cells;
  for (const MarkerDot& dot : in_cells) cells.at(dot.cell) = options.sure;
  for (int row = 0; row < marker_grid_size; ++row) {
    for (int column = 0; column < marker_grid_size; ++column) {
      if (cells.at({row, column}) > 0.0) continue;
      cells.at({row, column}) = seen.odds_at(gray, grid.center_px({row, column}));
    }
  }
  return cells;
}

std::size_t dots_within(const MarkerGrid& grid, std::span<const Dot> dots) {
  constexpr double reach_pitches = 2.3;  // corner dots are at 2.12
  const Vec2 middle = 0.5 * (grid.center_px(cell_of_x) + grid.center_px(cell_of_y));
  const double reach_px = reach_pitches * grid.pitch_px();
  return static_cast<std::size_t>(std::ranges::count_if(
      dots, [&](const Dot& dot) { return (dot.center_px - middle).squaredNorm() < reach_px * reach_px; }));
}

bool shows_a_cover(const MarkerGrid& grid, std::span<const Dot> dots, std::span<const Dot> of_frame,
                   const CellEvidenceOptions& options) {
  InlineVector<double, MarkerDots::static_capacity> radii;
  double smallest_px = std::numeric_limits<double>::infinity();
  for (const Dot& dot : dots) {
    radii.push_back(dot.radius_px);
    const double whole = dot.on_structure ? options.whole_dot_on_structure : options.whole_dot;
    smallest_px = std::min(smallest_px, dot.radius_px * options.whole_dot / whole);
  }
  if (radii.empty()) return false;
  std::ranges::sort(radii);
  const double usual_px = *(radii.begin() + radii.size() / 2);
  return smallest_px < options.whole_dot * usual_px - options.whole_dot_tolerance_px2 / usual_px ||
         dots_within(grid, of_frame) > dots.size();
}

}  // namespace lodestar
