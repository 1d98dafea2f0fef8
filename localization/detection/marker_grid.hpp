#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "localization/detection/detected_marker.hpp"

namespace lodestar {

inline constexpr double radii_per_pitch = marker_pitch_m / marker_dot_radius_m;

/// Maps a marker's grid to the image by a homography about the grid's middle. The perspective of so small a
/// marker is slight, so a prior holds it near zero.
class MarkerGrid {
 public:
  /// Affine, through the three direction dots.
  MarkerGrid(const Vec2& o_px, const Vec2& x_px, const Vec2& y_px);

  /// Least-squares fit to all dots. With three dots this is the grid through them.
  static MarkerGrid fitted(std::span<const MarkerDot> dots, const MarkerGrid& start);

  /// Image position of the cell's centre.
  [[nodiscard]] Vec2 center_px(GridCell cell) const;

  /// Cell of a dot: T of Eq. (6)-(8). Nothing when it is farther than `tolerance` (in pitches) from the
  /// cell's centre, or outside the grid. Ignores perspective.
  [[nodiscard]] std::optional<GridCell> cell_at(const Vec2& dot_px, double tolerance) const;

  /// Pixels per pitch: root of a cell's area.
  [[nodiscard]] double pitch_px() const;

 private:
  Vec2 middle_px_;
  Eigen::Matrix2d px_from_pitches_;  ///< columns: one pitch towards X, one towards Y
  Vec2 perspective_ = Vec2::Zero();  ///< relative change of depth, per pitch towards X and towards Y
};

}  // namespace lodestar
