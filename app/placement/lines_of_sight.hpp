#pragma once

#include "app/placement/coverage.hpp"

namespace lodestar {

/// Lines of sight over a floor to its ceiling, between points given in cells from the grid's corner.
class LinesOfSight {
 public:
  explicit LinesOfSight(const CoveredFloor& floor);

  [[nodiscard]] Vec2 in_cells(const Vec2& on_map) const;

  /// Is nothing in these cells that could hide a marker?
  [[nodiscard]] bool is_clear(Cell low, Cell high) const;

  /// From a camera above `at` to a marker.
  [[nodiscard]] bool is_free(const Vec2& at, const Vec2& marker, double marker_z_m) const;

 private:
  /// Occupied cells directly below the marker do not hide it: they do not reach the ceiling.
  [[nodiscard]] bool is_free_on_map(const Vec2& at, const Vec2& marker) const;

  /// Cells within touch_m of the camera or of the marker, such as the ceiling, do not count as obstacles
  /// between them.
  [[nodiscard]] bool is_free_in_height(const HeightBands& heights, const Vec2& at, const Vec2& marker,
                                       double marker_z_m) const;

  const CoveredFloor& floor_;
  Pose2 grid_from_map_;
};

}  // namespace lodestar
