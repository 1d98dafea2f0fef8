#pragma once

#include <cstdint>
#include <vector>

#include "drivers/simulation/simulated_camera_options.hpp"
#include "maps/marker_registry.hpp"

// The objects on the simulated ceiling, in the map frame. Gray values are those at the image centre before
// noise; above 255 the sensor saturates.
namespace lodestar {

/// A horizontal disc: a marker's dot, a lamp, a glint.
struct CeilingDisc {
  Vec3 center_m = Vec3::Zero();
  double radius_m = 0.0;
  double gray = 0.0;
};

/// A horizontal fluorescent tube.
struct CeilingTube {
  Vec3 from_m = Vec3::Zero();
  Vec3 to_m = Vec3::Zero();
  double radius_m = 0.0;
  double gray = 0.0;
};

struct CeilingMarker {
  Vec3 middle_m = Vec3::Zero();  ///< centre of the 4 x 4 grid
  Eigen::Isometry3d map_from_marker = Eigen::Isometry3d::Identity();
  std::vector<CeilingDisc> dots;
};

struct Ceiling {
  double height_m = 0.0;              ///< height of the ceiling plane: the median of the markers
  Vec2 tile_corner_m = Vec2::Zero();  ///< corner of the first tile
  std::vector<CeilingMarker> markers;
  std::vector<CeilingTube> tubes;
  std::vector<CeilingDisc> lamps;
  std::vector<CeilingDisc> glints;  ///< small specular spots, some as large as a dot
};

/// Half the side of a marker's film; no glint lies on it.
inline constexpr double marker_film_half_side_m = 0.085;

/// A ceiling with the registry's markers only. Deterministic in the seed.
std::vector<CeilingMarker> hang_markers(const MarkerRegistry& registry, const SimulatedCameraOptions& options,
                                        std::uint64_t seed);

/// A full ceiling around the registry's markers, extending some metres beyond them on all sides. Tubes and
/// lamps keep clear of the markers, as in a real installation; glints keep off their film only. Markers that
/// share an ID are all present. The tiles' position also depends on the seed, since a survey does not record
/// it.
Ceiling fit_ceiling(const MarkerRegistry& registry, const SimulatedCameraOptions& options,
                    std::uint64_t seed);

}  // namespace lodestar
