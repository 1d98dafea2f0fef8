#pragma once

#include <optional>
#include <vector>

#include "app/site/site.hpp"
#include "localization/pose/pose_fix.hpp"
#include "maps/marker_registry.hpp"
#include "maps/occupancy_map.hpp"
#include "maps/sight_lines.hpp"

namespace lodestar {

struct VisibilityOptions {
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();
  PoseFixOptions fix;           ///< of the camera as mounted: its prior, and how sharp dots are
  int headings = 8;             ///< tried in each cell
  double robot_radius_m = 0.0;  ///< cells nearer to an obstacle are left out: the robot is never there
  double border_px = 8.0;       ///< a marker is seen when all its dots lie farther inside the image
  int stride = 1;               ///< looked at is the middle one of each so many by so many cells

  /// The cell that is looked at for the square that begins at `corner`.
  [[nodiscard]] Cell cell_in_stride(const OccupancyMap& on, Cell corner) const;
};

/// What such a robot sees on the floor of a map.
VisibilityOptions visibility_options(const Robot& robot);

/// What a robot sees that stands in one cell.
struct CellView {
  int least = 0;  ///< markers seen, at the worst heading
  int most = 0;   ///< and at the best
  /// To be expected of a single fix, at the worst heading; nothing where some heading sees no marker.
  std::optional<double> position_sigma_m;  ///< the larger principal one of the base
  std::optional<double> heading_sigma_rad;
};

struct Visibility {
  OccupancyMap map;
  std::vector<std::optional<CellView>> cells;  ///< as map.cells; nothing where the robot cannot be
};

struct VisibilitySummary {
  std::size_t cells = 0;
  double share_one = 0.0;           ///< of the cells, that see a marker at every heading
  double share_two = 0.0;           ///< two
  double share_some_heading = 0.0;  ///< a marker, at some heading at least
  double largest_gap_m = 0.0;  ///< the longest way to the nearest cell that sees a marker at every heading
  Vec2 gap_at_m = Vec2::Zero();
  std::size_t cells_cut_off = 0;  ///< from which no way leads to such a cell
  std::optional<double> position_sigma_p50_m;
  std::optional<double> position_sigma_p95_m;
  std::optional<double> heading_sigma_p95_rad;
};

/// How many markers a robot sees from each free cell, and how sure of its pose it can be there. With
/// `sight_lines` nothing known to be occupied may stand in between.
Visibility visibility_of(const OccupancyMap& map, const MarkerRegistry& registry, const CameraModel& camera,
                         const SightLines* sight_lines, const VisibilityOptions& options);

VisibilitySummary summarize(const Visibility& visibility);

}  // namespace lodestar
