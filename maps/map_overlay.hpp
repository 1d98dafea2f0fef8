#pragma once

#include <Eigen/Core>
#include <span>

#include "maps/obstacle_field.hpp"
#include "maps/occupancy_map.hpp"

// What a scanner sees, held against the map.
namespace lodestar {

/// The map with the cells occupied that hold one of these points of the map frame; points beside the map are
/// passed over.
OccupancyMap overlaid(OccupancyMap map, std::span<const Vec2> occupied_in_map);

/// The same map with each cell split into parts by parts of its value.
OccupancyMap split(const OccupancyMap& map, int parts);

struct MapExplanationOptions {
  double range_sigma_m = 0.015;  ///< of cheap scanners: RPLIDAR A1, LD19 data sheets, 1 to 3 cm
  double sigmas = 3.0;
  /// Farther than this from everything mapped, nothing is explained however uncertain the pose: half a leg's
  /// width would be, next to every wall.
  double most_m = 0.20;
};

/// Whether what a scanner hits is on the map, as seen with an uncertain pose. Only occupied cells explain;
/// unknown ones do not.
class MapExplanation {
 public:
  /// The covariance is of (x_m, y_m, yaw_rad) of the base in the map frame. The field must outlive this.
  MapExplanation(const ObstacleField& field, const Eigen::Matrix3d& covariance,
                 const MapExplanationOptions& options = {});

  /// Is an occupied cell within 3 sigma of pose and range, plus one cell, of this hit?
  [[nodiscard]] bool explains(const Vec2& hit_in_map, double range_m) const;

 private:
  const ObstacleField* field_;
  MapExplanationOptions options_;
  Eigen::Matrix2d cells_from_map_;  ///< the grid's axes, in cells per metre
  double position_variance_m2_ = 0.0;
  double heading_variance_ = 0.0;
};

}  // namespace lodestar
