#include "drivers/simulation/tilt_wobble.hpp"

#include <cmath>

namespace lodestar {

TiltWobble::TiltWobble(double sigma_rad, Random random)
    : amplitude_rad_(sigma_rad * std::sqrt(2.0 / static_cast<double>(Waves{}.size()))),
      roll_(draw_waves(random)),
      pitch_(draw_waves(random)) {}

Eigen::Isometry3d TiltWobble::at(Stamp stamp) const {
  const RollPitchYaw tilt{angle_rad(roll_, stamp), angle_rad(pitch_, stamp), 0.0};
  Eigen::Isometry3d level_from_tilted = Eigen::Isometry3d::Identity();
  level_from_tilted.linear() = rotation_from(tilt);
  return level_from_tilted;
}

TiltWobble::Waves TiltWobble::draw_waves(Random& random) {
  constexpr double lowest_hz = 0.2;
  constexpr double highest_hz = 3.0;
  Waves waves;
  for (Wave& wave : waves) {
    const double hz = lowest_hz * std::pow(highest_hz / lowest_hz, random.uniform());
    wave = {2.0 * std::numbers::pi * hz, random.uniform(0.0, 2.0 * std::numbers::pi)};
  }
  return waves;
}

double TiltWobble::angle_rad(const Waves& waves, Stamp stamp) const {
  double sum = 0.0;
  for (const Wave& wave : waves) sum += std::sin(wave.frequency_radps * seconds(stamp) + wave.phase_rad);
  return amplitude_rad_ * sum;
}

}  // namespace lodestar
