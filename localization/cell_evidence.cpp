#include "localization/cell_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace lodestar {
namespace {

double mean_of(std::span<const Dot> dots, double Dot::* value) {
  double sum = 0.0;
  for (const Dot& dot : dots) sum += dot.*value;
  return sum / static_cast<double>(dots.size());
}

/// Mean of the 3 x 3 pixels about a place; nothing when a dot there would not lie wholly in the frame.
std::optional<double> gray_about(const cv::Mat& gray, const Vec2& center_px, double radius_px) {
  const auto u = static_cast<int>(std::lround(center_px.x()));
  const auto v = static_cast<int>(std::lround(center_px.y()));
  const int reach = std::max(static_cast<int>(std::ceil(radius_px)), 1);
  if (u < reach || v < reach || u + reach >= gray.cols || v + reach >= gray.rows) return std::nullopt;
  int sum = 0;
  for (int j = v - 1; j <= v + 1; ++j) {
    const auto* row = gray.ptr<std::uint8_t>(j);
    sum += row[u - 1] + row[u] + row[u + 1];
  }
  return sum / 9.0;
}

}  // namespace

CellEvidence look_at_cells(const cv::Mat& gray, const MarkerGrid& grid, std::span<const MarkerDot> in_cells,
                           std::span<const Dot> dots, const CellEvidenceOptions& options) {
  const double radius_px = mean_of(dots, &Dot::radius_px);
  const double background = mean_of(dots, &Dot::background_gray);
  const double contrast = mean_of(dots, &Dot::contrast_gray);
  const double slope = options.sure / (options.unsure_contrast - options.dark_contrast);
  CellEvidence cells;
  for (int row = 0; row < marker_grid_size; ++row) {
    for (int column = 0; column < marker_grid_size; ++column) {
      const std::optional<double> seen = gray_about(gray, grid.center_px({row, column}), radius_px);
      if (!seen) continue;
      // Darker than the film is as strange as brighter: something hangs before it.
      const double share = std::abs(*seen - background) / contrast;
      cells.at({row, column}) = std::clamp((share - options.unsure_contrast) * slope, -options.sure, 0.0);
    }
  }
  for (const MarkerDot& dot : in_cells) cells.at(dot.cell) = options.sure;
  return cells;
}

}  // namespace lodestar
