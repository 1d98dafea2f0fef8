#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include "app/site/site.hpp"
#include "localization/pose/pose_fix.hpp"
#include "maps/marker_registry.hpp"
#include "maps/occupancy_map.hpp"
#include "maps/sight_lines.hpp"

namespace lodestar {

struct VisibilityOptions {
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();
  PoseFixOptions fix;           ///< prior of the mounted camera, and sigma of a dot's centre
  int headings = 8;             ///< evaluated in each cell
  double robot_radius_m = 0.0;  ///< cells nearer to an obstacle are skipped: the robot cannot be there
  double border_px = 8.0;       ///< a marker is seen when all its dots lie farther inside the image
  std::stop_token cancelled;    ///< ends early, with the cells that it has
  int stride = 1;               ///< one cell is evaluated in the middle of each stride x stride block

  /// The cell evaluated for the block that begins at `corner`.
  [[nodiscard]] Cell cell_in_stride(const OccupancyMap& on, Cell corner) const;
};

/// The options for such a robot.
VisibilityOptions visibility_options(const Robot& robot);

/// The visibility of markers from one cell.
struct CellView {
  int least = 0;  ///< markers seen, at the worst heading
  int most = 0;   ///< and at the best
  /// Standard deviations expected of a single fix, at the worst heading; nothing where some heading sees no
  /// marker.
  std::optional<double> position_sigma_m;  ///< of the base, along the larger principal axis
  std::optional<double> heading_sigma_rad;
};

struct Visibility {
  OccupancyMap map;
  std::vector<std::optional<CellView>> cells;  ///< as map.cells; nothing where the robot cannot be
};

struct VisibilitySummary {
  std::size_t cells = 0;
  double share_one = 0.0;           ///< share of the cells that see a marker at every heading
  double share_two = 0.0;           ///< two
  double share_some_heading = 0.0;  ///< a marker, at some heading at least
  double largest_gap_m = 0.0;       ///< longest path to the nearest cell that sees a marker at every heading
  Vec2 gap_at_m = Vec2::Zero();
  std::size_t cells_cut_off = 0;  ///< from which no such cell can be reached
  std::optional<double> position_sigma_p50_m;
  std::optional<double> position_sigma_p95_m;
  std::optional<double> heading_sigma_p95_rad;
};

/// How many markers a robot sees from each free cell, and the standard deviations of a fix there. With
/// `sight_lines` occupied voxels in between hide a marker.
Visibility visibility_of(const OccupancyMap& map, const MarkerRegistry& registry, const CameraModel& camera,
                         const SightLines* sight_lines, const VisibilityOptions& options);

VisibilitySummary summarize(const Visibility& visibility);

}  // namespace lodestar
