#include "localization/detection/cell_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "localization/detection/disc_light.hpp"

namespace lodestar {
namespace {

double mean_of(std::span<const Dot> dots, double Dot::* value) {
  double sum = 0.0;
  for (const Dot& dot : dots) sum += dot.*value;
  return sum / static_cast<double>(dots.size());
}

}  // namespace

CellEvidence evidence_of_cells(const cv::Mat& gray, const MarkerGrid& grid,
                               std::span<const MarkerDot> in_cells, std::span<const Dot> dots,
                               const CellEvidenceOptions& options) {
  const double radius_px = mean_of(dots, &Dot::radius_px);
  const double background = mean_of(dots, &Dot::background_gray);
  const double contrast = mean_of(dots, &Dot::contrast_gray);
  const double light_of_a_dot = std::numbers::pi * radius_px * radius_px * contrast;
  const double slope = options.sure / (options.unsure_contrast - options.dark_contrast);
  const double unsure = options.unsure_contrast + options.small_dot_contrast_px2 / (radius_px * radius_px);
  CellEvidence cells;
  for (const MarkerDot& dot : in_cells) cells.at(dot.cell) = options.sure;
  for (int row = 0; row < marker_grid_size; ++row) {
    for (int column = 0; column < marker_grid_size; ++column) {
      if (cells.at({row, column}) > 0.0) continue;
      const std::optional<DiscLight> seen =
          light_in_disc(gray, grid.center_px({row, column}), radius_px, background);
      if (!seen) continue;
      // Darker than the film is as implausible as brighter: an occluder is in front of it.
      const double share = std::abs(seen->mass) / light_of_a_dot;
      cells.at({row, column}) = std::clamp((share - unsure) * slope, -options.sure, 0.0);
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
  for (const Dot& dot : dots) radii.push_back(dot.radius_px);
  if (radii.empty()) return false;
  std::ranges::sort(radii);
  const double usual_px = *(radii.begin() + radii.size() / 2);
  return *radii.begin() < options.whole_dot * usual_px - options.whole_dot_tolerance_px2 / usual_px ||
         dots_within(grid, of_frame) > dots.size();
}

}  // namespace lodestar
