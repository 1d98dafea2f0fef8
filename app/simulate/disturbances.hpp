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
};

/// The simulated world's options with these disturbances.
SimulationOptions with_disturbances(SimulationOptions options, const Disturbances& disturbances);

/// The remaining markers, drawn from the seed. The one nearest to each of `places_m` stays: without any
/// marker in view a robot can neither start nor arrive to the centimetre.
MarkerRegistry with_markers_removed(const MarkerRegistry& registry, double share,
                                    const std::vector<Vec2>& places_m, std::uint64_t seed);

}  // namespace lodestar
