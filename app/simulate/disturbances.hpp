#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/simulation/simulation.hpp"

namespace lodestar {

/// What makes a simulated drive harder than an ordinary one.
struct Disturbances {
  std::optional<double> lost_frames;  ///< this share of the camera's frames never arrives
  /// The left wheel rolls farther than its encoder says and the right one less: so much, in all, of the way.
  std::optional<double> unequal_wheels;
  double removed_markers = 0.0;  ///< this share of the markers no longer hangs; the robot does not know it
  bool plain_ceiling = false;    ///< nothing else is to be seen on it: no joints, stains or lamps
};

/// The simulated world's options with these hardships.
SimulationOptions made_harder(SimulationOptions options, const Disturbances& disturbances);

/// The markers that are left, drawn from the seed. The one nearest to each of `places_m` stays: where no
/// marker is seen at all no robot can begin, nor arrive to the centimetre.
MarkerRegistry with_markers_removed(const MarkerRegistry& registry, double share,
                                    const std::vector<Vec2>& places_m, std::uint64_t seed);

}  // namespace lodestar
