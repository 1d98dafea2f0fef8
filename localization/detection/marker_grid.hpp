#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "localization/detection/detected_marker.hpp"

namespace lodestar {

/// How a marker's grid lies in the image: a plane seen in perspective, written about the grid's middle. The
/// perspective of so small a marker is slight, so it is only believed as far as the dots demand it.
class MarkerGrid {
 public:
  /// Through the three direction dots, without perspective.
  MarkerGrid(const Vec2& o_px, const Vec2& x_px, const Vec2& y_px);

  /// Nearest to all dots, by least squares. With three dots this is the grid through them.
  static MarkerGrid fitted(std::span<const MarkerDot> dots, const MarkerGrid& start);

  /// Where the cell's centre is in the image.
  [[nodiscard]] Vec2 center_px(GridCell cell) const;

  /// The cell that a dot stands in: T of Eq. (6)-(8). Nothing when it is farther than `tolerance` (in
  /// pitches) from the cell's centre, or outside the grid. Without perspective.
  [[nodiscard]] std::optional<GridCell> cell_at(const Vec2& dot_px, double tolerance) const;

  /// Pixels a pitch, as the root of the area of a cell.
  [[nodiscard]] double pitch_px() const;

 private:
  Vec2 middle_px_;
  Eigen::Matrix2d px_from_pitches_;  ///< columns: one pitch towards X, one towards Y
  Vec2 perspective_ = Vec2::Zero();  ///< how much nearer to the camera, a pitch towards X and towards Y
};

}  // namespace lodestar
