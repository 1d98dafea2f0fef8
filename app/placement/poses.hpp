#pragma once

#include <optional>

#include "maps/marker_registry.hpp"

// Where a format puts a marker's frame, and which way its axes point.
namespace lodestar {

/// Another program's marker frame, fixed to the marker.
enum class MarkerFrame {
  at_o,               ///< ours: at dot O, x to X, y to Y, z out of the face
  at_center,          ///< the same axes at the centre of the square (ArUco, fiducial_slam)
  out_of_the_center,  ///< at the centre, x out of the face, y to the right, z to the top (WPILib)
};

/// The pose of that frame in the map.
Eigen::Isometry3d map_from_frame(const MarkerRegistry& registry, const RegisteredMarker& marker,
                                 MarkerFrame frame);

/// The marker whose frame has this pose; nothing when its face is not downward within 5 degrees. Smaller
/// tilts are dropped.
std::optional<RegisteredMarker> marker_at(int id, const Eigen::Isometry3d& map_from_frame, MarkerFrame frame);

}  // namespace lodestar
