#pragma once

#include <cstdint>
#include <vector>

#include "drivers/simulation/simulated_camera_options.hpp"
#include "maps/marker_registry.hpp"

// What hangs on the simulated ceiling, in the map frame. Gray values are what the camera's middle would show
// before noise; above 255 the sensor saturates.
namespace lodestar {

/// A round, horizontal face: a marker's dot, a lamp, a glint.
struct CeilingDisc {
  Vec3 center_m = Vec3::Zero();
  double radius_m = 0.0;
  double gray = 0.0;
};

/// A fluorescent tube, lying horizontally.
struct CeilingTube {
  Vec3 from_m = Vec3::Zero();
  Vec3 to_m = Vec3::Zero();
  double radius_m = 0.0;
  double gray = 0.0;
};

struct CeilingMarker {
  Vec3 middle_m = Vec3::Zero();  ///< of the 4 x 4 grid
  Eigen::Isometry3d map_from_marker = Eigen::Isometry3d::Identity();
  std::vector<CeilingDisc> dots;
};

struct Ceiling {
  double height_m = 0.0;              ///< of the plain ceiling: the median of the markers
  Vec2 tile_corner_m = Vec2::Zero();  ///< of some tile: where the first one was laid
  std::vector<CeilingMarker> markers;
  std::vector<CeilingTube> tubes;
  std::vector<CeilingDisc> lamps;
  std::vector<CeilingDisc> glints;  ///< small specular spots, some as large as a dot
};

/// Half the side of a marker's film; no glint shines through it.
inline constexpr double marker_film_half_side_m = 0.085;

/// Hangs up the registry's markers alone. Deterministic in the seed.
std::vector<CeilingMarker> hang_markers(const MarkerRegistry& registry, const SimulatedCameraOptions& options,
                                        std::uint64_t seed);

/// Fits the ceiling around the registry's markers, some metres beyond them to all sides. Tubes and lamps keep
/// clear of the markers, as an electrician and a surveyor would; glints keep off their film only. Markers
/// that share an ID all hang there. Where the tiles lie is by the seed too: a survey knows nothing of them.
Ceiling fit_ceiling(const MarkerRegistry& registry, const SimulatedCameraOptions& options,
                    std::uint64_t seed);

}  // namespace lodestar
