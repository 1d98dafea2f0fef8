#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "maps/geometry.hpp"
#include "maps/motion.hpp"

namespace lodestar {

/// How the wheels differ from each other and how far apart they are, in units of their readings: the left one
/// rolls (1 - difference) of what it reports, the right one (1 + difference). What a reported metre is in
/// metres is another question, which no composition depends on.
struct WheelGauge {
  double difference = 0.0;
  double track_m = 0.4;  ///< in reported metres
};

/// Standard deviations of what wheels report; each grows with the root of the way rolled.
struct WheelNoise {
  double encoder_sigma_m = 0.0005;           ///< of a reading
  double slip_sigma_per_sqrt_m = 0.003;      ///< random slip of each wheel
  double sideways_sigma_per_sqrt_m = 0.001;  ///< lateral slip of the base
};

/// Travel of the left and the right wheel at a time, linear between the readings on either side of it;
/// nothing before the first, after the last, or in a longer gap.
std::optional<Vec2> travel_at(std::span<const WheelTravel> readings, Stamp stamp,
                              Duration most_gap = Duration::max());

/// Motion of the base between two times, in its frame at the first, in reported metres.
struct WheelMotion {
  Vec2 way_m = Vec2::Zero();
  double turn_rad = 0.0;
  Eigen::Matrix<double, 3, 2> by_gauge = Eigen::Matrix<double, 3, 2>::Zero();  ///< of (way, turn)
};

/// Wheel readings between two times, composed one by one: a single arc over a turn and a straight would be
/// off by centimetres.
class WheelSegment {
 public:
  /// Nothing where the readings do not cover the times or have a gap longer than `most_gap` at them.
  static std::optional<WheelSegment> between(std::span<const WheelTravel> readings, Stamp from, Stamp to,
                                             Duration most_gap = std::chrono::milliseconds(500));

  [[nodiscard]] WheelMotion motion(const WheelGauge& gauge) const;

  /// Covariance of (way, turn), propagated reading by reading.
  [[nodiscard]] Eigen::Matrix3d covariance(const WheelGauge& gauge, const WheelNoise& noise) const;

  /// Sum of both wheels' travel, halved: how far the base rolled, whatever the direction.
  [[nodiscard]] double rolled_m() const;
  [[nodiscard]] Vec2 travel_m() const;  ///< left and right, from the first reading to the last

 private:
  std::vector<Vec2> steps_m_;  ///< left and right
};

}  // namespace lodestar
