#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/simulation/simulation.hpp"

namespace lodestar {

/// Disturbances of a simulated drive beyond the ordinary noise.
struct Disturbances {
  std::optional<double> lost_frames;  ///< this share of the camera's frames never arrives
  /// Relative difference of the wheels' true travel: the left rolls farther than its encoder reports and the
  /// right less, by half of this each.
  std::optional<double> unequal_wheels;
  double removed_markers = 0.0;  ///< share of markers missing from the ceiling; the robot's registry has them
  bool plain_ceiling = false;    ///< without texture: no joints, stains or lamps
  /// The markers that hang, where the site's registry, which is what the robot knows, is not true.
  std::optional<MarkerRegistry> hung;
  /// Markers hang off where they should, drawn from the seed: standard deviations of x and y, of the yaw, and
  /// of the tilt about each horizontal axis.
  double misplaced_m = 0.0;
  double misturned_rad = 0.0;
  double tilted_rad = 0.0;
  double print_scale = 1.0;  ///< true size of the markers over the nominal one
};

/// The simulated world's options with these disturbances.
SimulationOptions with_disturbances(SimulationOptions options, const Disturbances& disturbances);

/// The markers that hang over a site with this registry, drawn from the seed. Of those that are removed, the
/// one nearest to each of `places_m` stays: without any marker in view a robot can neither start nor arrive
/// to the centimetre.
MarkerRegistry hung_markers(const MarkerRegistry& registry, const Disturbances& disturbances,
                            const std::vector<Vec2>& places_m, std::uint64_t seed);

}  // namespace lodestar
