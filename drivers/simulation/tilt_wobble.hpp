#pragma once

#include <array>

#include "maps/geometry.hpp"
#include "maps/random.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// Small roll and pitch of the body on an uneven floor: for each axis a sum of sines between 0.2 and 3 Hz
/// with random phases, hence smooth and defined at any time.
class TiltWobble {
 public:
  /// sigma_rad: standard deviation over time, each axis.
  TiltWobble(double sigma_rad, Random random);

  /// level_from_tilted: rotation of the base frame about its origin on the floor.
  [[nodiscard]] Eigen::Isometry3d at(Stamp stamp) const;

 private:
  struct Wave {
    double frequency_radps = 0.0;
    double phase_rad = 0.0;
  };
  using Waves = std::array<Wave, 7>;

  static Waves draw_waves(Random& random);
  [[nodiscard]] double angle_rad(const Waves& waves, Stamp stamp) const;

  double amplitude_rad_;  ///< of one sine
  Waves roll_;
  Waves pitch_;
};

}  // namespace lodestar
